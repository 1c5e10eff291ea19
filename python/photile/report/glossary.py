"""Terms of reports in a sentence each."""

from __future__ import annotations

from .texts import Words

# Term, the texts of a page that it explains, and its meaning.
_terms = [
    ("E<sub>m</sub>", "E<sub>m</sub>",
     "mean illuminance of the points of a grid, with the maintenance factor: what a room has at least until it "
     "is maintained (EN 12464-1)"),
    ("E<sub>min</sub>, E<sub>max</sub>", "E<sub>min</sub>",
     "illuminance at the darkest and at the brightest point"),
    ("U<sub>o</sub>", "U<sub>o</sub>",
     "uniformity, the least illuminance over the mean"),
    ("U<sub>d</sub>", "U<sub>d</sub>",
     "diversity, the least illuminance over the highest"),
    ("±", '<span class="error">',
     "standard error: two times in three the true value lies within it, 19 times in 20 within twice of it"),
    ("UGR", "UGR",
     "unified glare rating (CIE 117), from 10, imperceptible, to 28, uncomfortable; a step that is noticed is 3"),
    ("DGP", "DGP",
     "daylight glare probability: the share of people who are disturbed; 0.35 imperceptible, 0.45 intolerable"),
    ("R<sub>a</sub>", "Ra<",
     "colour rendering index, 100 at most"),
    ("maintenance factor", "maintenance factor",
     "the part of a new installation's light that is left when it is maintained"),
    ("power density", "power density",
     "electrical power of the luminaires over the floor area, also for each 100 lux"),
    ("LENI", "LENI",
     "lighting energy of a year over the floor area (EN 15193)"),
    ("daylight factor", "Daylight factors",
     "illuminance in the room over that on open ground under an overcast sky"),
    ("DA", ">DA",
     "daylight autonomy: the part of the occupied hours with enough lux by daylight alone"),
    ("sDA", "sDA",
     "spatial daylight autonomy: the part of the points with enough lux in half of the occupied hours"),
    ("ASE", "ASE",
     "annual sunlight exposure: the part of the points with sun above 1000 lux for more than 250 occupied hours"),
    ("UDI", "UDI",
     "useful daylight illuminance: the part of the occupied hours with 100 to 3000 lux"),
    ("melanopic EDI", "Melanopic EDI (CIE S 026)",
     "illuminance by daylight (D65) that acts on the body's clock as this light does"),
]


def used(page: str, words: Words) -> list[tuple[str, str]]:
    """The terms that a page has, in its language, with their meanings, in HTML."""
    return [(words(term), words(meaning)) for term, sign, meaning in _terms if words(sign) in page]
