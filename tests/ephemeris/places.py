"""Places on Earth."""

import math

from skybake.ephemeris.place import Place


def at(latitude, longitude):
    return Place(math.radians(latitude), math.radians(longitude))


PARIS = at(48.8566, 2.3522)
QUITO = at(-0.1807, -78.4678)
TROMSO = at(69.6492, 18.9553)
USHUAIA = at(-54.8019, -68.3030)
PLACES = {
    "paris": PARIS,
    "quito": QUITO,
    "tromso": TROMSO,
    "ushuaia": USHUAIA,
    "north pole": at(90.0, 0.0),
    "south pole": at(-90.0, 40.0),
    "east of the antimeridian": at(52.0, 180.0),
    "west of the antimeridian": at(-17.0, -179.999),
}
