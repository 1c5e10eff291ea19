#!/usr/bin/python3
"""Makes the bundled scenes beside this file: cornell-box/, living-room/, gallery/ and
office/.

Usage: scenes/make_scenes.py [folder]      (default: the folder of this file)

Needs Python 3.9 and its standard library. The output depends on nothing else, so running it again
gives the committed files, byte for byte.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from scene_tools import cornell_box, gallery, living_room, office  # noqa: E402 (the path comes first)


def main():
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).parent
    cornell_box.write(folder / "cornell-box")
    living_room.write(folder / "living-room")
    gallery.write(folder / "gallery")
    office.write(folder / "office")


if __name__ == "__main__":
    main()
