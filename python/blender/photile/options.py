# SPDX-License-Identifier: MIT
"""Options of `photile render` that a .blend file, which may come from anyone, may contain."""

import shlex

# Those that neither read nor write a file that they name, nor load a library.
_VALUED = frozenset(
    "area-light exposure field-of-view for integrator light light-group neighbours photons portals "
    "projection quality reflectance samples seed set site size sky sun target-error threads time "
    "view".split()
)
_SWITCHES = frozenset(["denoise", "quiet"])
_SHORT = {"-k": "--neighbours", "-q": "--quiet"}


def without_files(text):
    """The words of a command line, each with its value: "--samples 4" is "--samples=4".

    Raises ValueError that names the first option which is not one of these.
    """
    words, result = iter(shlex.split(text)), []
    for word in words:
        option, equals, value = _SHORT.get(word, word).partition("=")
        name = option[2:] if option.startswith("--") else ""
        if name in _SWITCHES and not equals:
            result.append(option)
        elif name in _VALUED:
            result.append(f"{option}={value if equals else next(words, '')}")
        else:
            raise ValueError(
                f"Options: '{word}' is not kept with a scene, which may come from others; give it "
                "in the preferences of the add-on"
            )
    return result
