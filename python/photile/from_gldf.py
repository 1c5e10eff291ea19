"""Luminaires of GLDF files (Global Lighting Data Format, a zip of product.xml and photometric files):
``photile import``.

Element names are those of the schema 1.0.0, https://github.com/globallightingdata/gldf. A luminaire's
shape is left out: photile's lamps are the luminous openings of their photometric files.
"""

from __future__ import annotations

import json
import math
import re
import xml.etree.ElementTree as xml
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from .converters import Conversion, unique, write_files
from .errors import InputError, UsageError

__all__ = ["convert"]

_endings = {"ldc/eulumdat": ".ldt", "ldc/ies": ".ies"}


# A product of a few kilobytes may hold references to references, each with a copy of a file.
_most_lights = 10_000
_most_product, _most_files = 16 << 20, 256 << 20  # bytes


def _by_id(product: xml.Element, path: str) -> dict[str, xml.Element]:
    return {element.get("id", ""): element for element in product.findall(path)}


def _text(element: xml.Element | None) -> str:
    return (element.text or "").strip() if element is not None else ""


def _read(archive: zipfile.ZipFile, name: str, most: int) -> bytes:
    member = archive.getinfo(name)
    if member.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        raise ValueError(f"{name} is neither stored nor deflated")  # the others unpack without bounds
    if member.file_size > most:
        raise ValueError(f"{name} has {member.file_size} bytes; photile reads at most {most}")
    return archive.read(member)


def _photometric_files(product: xml.Element) -> dict[str, tuple[str, str]]:
    """Ending and name in the archive of the file of each photometry that has one."""
    files = _by_id(product, "GeneralDefinitions/Files/File")
    found = {}
    for name, photometry in _by_id(product, "GeneralDefinitions/Photometries/Photometry").items():
        used = photometry.find("PhotometryFileReference")
        file = files.get(used.get("fileId", "")) if used is not None else None
        ending = _endings.get(file.get("contentType", "")) if file is not None else None
        if ending:
            found[name] = (ending, "ldc/" + _text(file))
    return found


def _lights(product: xml.Element) -> Iterator[tuple[str, str, str]]:
    """A name for each light that a variant has, its photometry and its rated flux or ""."""
    emitters: dict[str, list[tuple[str, str, str]]] = {}
    for name, emitter in _by_id(product, "GeneralDefinitions/Emitters/Emitter").items():
        emitters[name] = []
        for number, light in enumerate(emitter):
            reference = light.find("PhotometryReference")
            if reference is not None:
                emitters[name].append((f"{name} {number or ''}", reference.get("photometryId", ""),
                                       _text(light.find("RatedLuminousFlux"))))
    for variant in product.findall("ProductDefinitions/Variants/Variant"):
        used = dict.fromkeys(element.get("emitterId", "") for element in variant.iter())
        for emitter_id in used:
            for name, photometry, flux in emitters.get(emitter_id, ()):
                yield f"{variant.get('id')} {name}".strip(), photometry, flux


def _luminaires(gldf: Path) -> tuple[list[dict[str, Any]], dict[str, bytes]]:
    """Entries of ``luminaires.json``, and the files that they name."""
    entries: list[dict[str, Any]] = []
    written: dict[str, bytes] = {}
    contents: dict[str, bytes] = {}  # by their names in the archive
    with zipfile.ZipFile(gldf) as archive:
        product = xml.fromstring(_read(archive, "product.xml", _most_product))
        files = _photometric_files(product)
        there = {name for name in archive.namelist() if not name.endswith("/")}
        names: dict[str, int] = {}
        room = _most_files
        for number, (light, photometry, flux) in enumerate(_lights(product), 1):
            if number > _most_lights:
                raise ValueError(f"its variants have more than {_most_lights} lights")
            ending, member = files.get(photometry, ("", ""))
            if member not in there:
                continue
            if member not in contents:
                contents[member] = _read(archive, member, room)
            room -= len(contents[member])
            if room < 0:
                raise ValueError(f"the files of its lights have more than {_most_files} bytes")
            name = unique(re.sub(r"\W+", "_", light), names)  # other ids may become the same word
            written[name + ending] = contents[member]
            entries.append({"name": name, "file": name + ending, "position": "ceiling"})
            if flux:
                entries[-1]["lumens"] = float(flux)
                if not 0 <= float(flux) < math.inf:
                    raise ValueError(f"light '{light}' has a flux of {flux}")
    return entries, written


def convert(gldf: Path, folder: Path) -> Conversion:
    """Writes the photometric files of all variants and ``luminaires.json``, with an entry for each
    of their lights, into a new or empty folder.

    Errors: InputError where the file is not GLDF, or none of its variants has a photometric file
    in it; UsageError where the folder is not empty; OutputError.
    """
    try:
        entries, written = _luminaires(gldf)
    except OSError as error:
        raise InputError(f"{gldf}: {error.strerror}; name a GLDF file") from None
    except Exception as error:  # zipfile and its decompressors raise what they like on damaged files
        raise InputError(f"{gldf}: this is not a GLDF file: {error}; get the file again") from None
    if not entries:
        raise InputError(f"{gldf}: no variant has a photometric file (EULUMDAT or IES) in it")
    if folder.is_dir() and any(folder.iterdir()):
        raise UsageError(f"{folder}: the folder is not empty; name a new one")
    written["luminaires.json"] = (json.dumps(entries, indent=2) + "\n").encode()
    write_files({folder / name: content for name, content in written.items()})
    summary = [f"{entry['name']}: {entry['file']}" + (f", {entry['lumens']:g} lm" if "lumens" in entry else "")
               for entry in entries]
    return Conversion([["--luminaires", str(folder / "luminaires.json")]], summary)
