"""Makes skybake/data/night/stars.npy from the stars of the npm package d3-celestial.

    npm pack d3-celestial@0.7.35 && tar xf d3-celestial-0.7.35.tgz
    python docs/derivations/stars.py package/data/stars.8.json

The package (Olaf Frohn, BSD-3-Clause, see skybake/data/night/stars_license.txt) has them from XHIP
(Anderson & Francis 2012, Astronomy Letters 38, 331), places for J2000 without proper motions. These
are added for the bright stars that PyEphem names (Rhodes, MIT; XEphem's, after Hipparcos).
"""

import json
import sys
from pathlib import Path

import numpy as np
from ephem.stars import db

FAINTEST = 6.5
"""The catalogue of the package is complete to this V."""

USUAL_COLOUR = 0.6
"""B-V of the few stars that have none."""

MATCH = np.radians(40.0 / 3600.0)
"""From a named star: more than they moved in between the epochs of the two lists."""

MILLIARCSECOND = np.radians(1.0 / 3.6e6)

ROW = np.dtype(
    [
        ("right_ascension", "<f4"),
        ("declination", "<f4"),
        ("proper_motion_east", "<f4"),
        ("proper_motion_north", "<f4"),
        ("v", "<f4"),
        ("b_v", "<f4"),
    ]
)


def read_stars(path):
    """Return the stars of the package's file, the brightest first."""
    rows = []
    for star in json.loads(Path(path).read_text())["features"]:
        longitude, latitude = star["geometry"]["coordinates"]
        v, colour = star["properties"]["mag"], star["properties"]["bv"]
        if v <= FAINTEST:
            place = np.radians(longitude % 360.0), np.radians(latitude)
            rows.append((*place, 0.0, 0.0, v, float(colour) if colour else USUAL_COLOUR))
    stars = np.array(rows, ROW)
    return stars[np.argsort(stars["v"], kind="stable")]


def add_proper_motions(stars):
    """Write the motions of stars that PyEphem names, and return of how many."""
    found = 0
    for line in db.strip().splitlines():
        _, _, right_ascension, declination, v, *_ = line.split(",")
        (ra, east), (dec, north) = (text.split("|") for text in (right_ascension, declination))
        place = np.radians(15.0 * float(ra)), np.radians(float(dec))
        across = (stars["right_ascension"] - place[0]) * np.cos(place[1])
        distance = np.hypot(across, stars["declination"] - place[1])
        near = np.flatnonzero((distance < MATCH) & (abs(stars["v"] - float(v)) < 1.0))
        if near.size == 0:
            print("no match:", line)
            continue
        star = near[np.argmin(distance[near])]
        stars["proper_motion_east"][star] = float(east) * MILLIARCSECOND
        stars["proper_motion_north"][star] = float(north) * MILLIARCSECOND
        found += 1
    return found


if __name__ == "__main__":
    catalogue = read_stars(sys.argv[1])
    moved = add_proper_motions(catalogue)
    np.save(Path(__file__).parents[2] / "skybake/data/night/stars.npy", catalogue)
    flux = float((10.0 ** (-0.4 * catalogue["v"].astype(float))).sum())
    print(f"{len(catalogue)} stars, {moved} with motions, as bright as {flux:.2f} of V = 0")
