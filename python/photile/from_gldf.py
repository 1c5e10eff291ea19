"""Luminaires of GLDF files (Global Lighting Data Format, a zip of product.xml and photometric files):
``python3 -m photile.from_gldf``.

Element names are those of the schema 1.0.0, https://github.com/globallightingdata/gldf. A luminaire's
shape is left out: photile's lamps are the luminous openings of their photometric files.
"""

from __future__ import annotations

import argparse
import json
import re
import sys
import xml.etree.ElementTree as xml
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

__all__ = ["convert"]

_endings = {"ldc/eulumdat": ".ldt", "ldc/ies": ".ies"}


def _by_id(product: xml.Element, path: str) -> dict[str, xml.Element]:
    return {element.get("id", ""): element for element in product.findall(path)}


def _text(element: xml.Element | None) -> str:
    return (element.text or "").strip() if element is not None else ""


class _Product:
    """What product.xml says, and the photometric files beside it."""

    def __init__(self, gldf: Path) -> None:
        with zipfile.ZipFile(gldf) as archive:
            self.product = xml.fromstring(archive.read("product.xml"))
            self.contents = {name: archive.read(name) for name in archive.namelist()
                             if name.startswith("ldc/") and not name.endswith("/")}
        self.files = _by_id(self.product, "GeneralDefinitions/Files/File")
        self.photometries = _by_id(self.product, "GeneralDefinitions/Photometries/Photometry")
        self.emitters = _by_id(self.product, "GeneralDefinitions/Emitters/Emitter")

    def parts(self) -> Iterator[tuple[str, xml.Element]]:
        """A name for each light that a variant has, and its element."""
        for variant in self.product.findall("ProductDefinitions/Variants/Variant"):
            emitters = dict.fromkeys(element.get("emitterId", "") for element in variant.iter())
            for emitter in filter(None, map(self.emitters.get, emitters)):
                for number, part in enumerate(emitter):
                    name = f"{variant.get('id')} {emitter.get('id')} {number or ''}"
                    yield re.sub(r"\W+", "_", name.strip()), part

    def photometric_file(self, part: xml.Element) -> tuple[str, bytes] | None:
        """Ending and content of a light's file, where the archive has it."""
        reference = part.find("PhotometryReference")
        if reference is None:
            return None
        photometry = self.photometries.get(reference.get("photometryId", ""))
        used = photometry.find("PhotometryFileReference") if photometry is not None else None
        file = self.files.get(used.get("fileId", "")) if used is not None else None
        if file is None:
            return None
        ending = _endings.get(file.get("contentType", ""))
        content = self.contents.get("ldc/" + _text(file))
        return (ending, content) if ending and content else None


def convert(gldf: Path, folder: Path) -> list[dict[str, Any]]:
    """Writes the photometric files of all variants and ``luminaires.json``, with an entry for each
    of their lights, into a new or empty folder; returns the entries.

    Errors: ValueError where the file is no GLDF, or none of its variants has a photometric file
    in it. OSError.
    """
    try:
        product = _Product(gldf)
    except (zipfile.BadZipFile, KeyError, xml.ParseError) as error:
        raise ValueError(f"{gldf}: is no GLDF file: {error}") from None
    entries: list[dict[str, Any]] = []
    written: dict[str, bytes] = {}
    for name, part in product.parts():
        file = product.photometric_file(part)
        if file is None:
            continue
        ending, content = file
        written[name + ending] = content
        entries.append({"name": name, "file": name + ending, "position": "ceiling"})
        flux = _text(part.find("RatedLuminousFlux"))
        if flux:
            entries[-1]["lumens"] = float(flux)
    if not entries:
        raise ValueError(f"{gldf}: no variant has a photometric file (EULUMDAT or IES) in it")
    folder.mkdir(parents=True, exist_ok=True)
    if any(folder.iterdir()):
        raise ValueError(f"{folder}: is not empty; name a new folder")
    for file_name, content in written.items():
        (folder / file_name).write_bytes(content)
    (folder / "luminaires.json").write_text(json.dumps(entries, indent=2) + "\n", encoding="utf-8")
    return entries


def main() -> int:
    parser = argparse.ArgumentParser(prog="python3 -m photile.from_gldf",
                                     description="Photometric files and luminaires of a GLDF file.")
    parser.add_argument("gldf", type=Path)
    parser.add_argument("folder", type=Path, help="a new one")
    options = parser.parse_args()
    try:
        entries = convert(options.gldf, options.folder)
    except (ValueError, OSError) as error:
        print(f"photile.from_gldf: error: {error}", file=sys.stderr)
        return 1
    for entry in entries:
        print(f"{entry['name']}: {entry['file']}"
              + (f", {entry['lumens']:g} lm" if "lumens" in entry else ""))
    print(f"--luminaires {options.folder}/luminaires.json")
    return 0


if __name__ == "__main__":
    sys.exit(main())
