"""The land that the network learned from.

Heights of the Shuttle Radar Topography Mission (NASA, USGS), which are in the public domain, in UTM, by cubic
interpolation. A file is a GeoTIFF with square cells in metres and one band; its hash is that of the file.
"""

import hashlib
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Place:
    file: str
    land: str
    sha256: str


PLACES = (
    Place("atacama_90.tif", "the Atacama Desert, Chile", "3b55a93365cac47a95e110d62e9c76bfcd2fac50843a291da5ae164ae8b763b9"),
    Place("bernese_90.tif", "the Bernese Alps, Switzerland", "5895b37f464e41f878b3664256cde0d11e2ad176bd0f27e079f7e4ed1804f713"),
    Place("catalonia_90.tif", "Catalonia, Spain", "de07f1a2a448b3ba3ec852388129766de84cfa4104e4c3b6f3fe5b5bce8f158c"),
    Place("cotedazur_90.tif", "the Côte d'Azur, France", "b7d100afbbff37f5e797aa60b875e609fcc8872a74676e2afc9dd97f2520f7ff"),
    Place("franconian_90.tif", "Franconia, Germany", "3bf3f7ccec356075bb954f9b1151a39046b102c744fc57afb59ccba3a7abbf67"),
    Place("hawaii_90.tif", "Hawaii, USA", "0e48337e917d57988992a0ff22122d10767ea9b8232387b4a57402b30b43ac84"),
    Place("mandakini_90.tif", "the valley of the Mandakini, India", "45b6e6808cc3220aa00cf4258ce33a6632ddf2a66479bb67f7971d5a93acaf87"),
    Place("olympic_30.tif", "the Olympic Mountains, USA", "a80ca3035bae4f03062a5f228d04e4733f24afd3ae8331b8135c49cd837cf290"),
    Place("pyrenees_90.tif", "the Pyrenees, Andorra", "ab4e3de7fb3d62b008d05003c1b136651b682b31afb892039dc25b849d10b020"),
    Place("thuringian_90.tif", "Thuringia, Germany", "35f1125104fac1e57f43db5bb7c67d482c6159b6d5539b47a8d559179638b5e0"),
)


def path_of(place: Place, folder: Path) -> Path:
    """The file of a place, after its hash was compared.

    Raises SystemExit with a sentence if the file is missing or another one.
    """
    path = folder / place.file
    if not path.is_file():
        raise SystemExit(f"{path} is missing: it has the heights of {place.land}; see training/README.md")
    found = hashlib.sha256(path.read_bytes()).hexdigest()
    if found != place.sha256:
        raise SystemExit(f"{path} is another file than the one that the network learned from: its SHA-256 is {found}")
    return path
