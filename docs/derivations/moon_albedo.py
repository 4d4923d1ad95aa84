"""Makes skybake/data/night/moon_albedo.npy from a picture of the npm package globe.gl.

    npm pack globe.gl@2.46.2 && tar xf globe.gl-2.46.2.tgz
    python docs/derivations/moon_albedo.py package/example/moon-landing-sites/lunar_surface.jpg

The picture (globe.gl by Vasco Asturiano, MIT) is an equirect mosaic of the Moon, whose prime
meridian is in the middle. Its code values are proportional to the albedo, not to light that they
would decode to: maria to highlands are 0.49 once values are raised to 0.95, as measured (normal
albedo 0.07 to 0.14). The absolute level is that of the ROLO model, not of the picture.
"""

import sys
from pathlib import Path

import numpy as np
import OpenImageIO

TARGET = Path(__file__).parents[2] / "skybake" / "data" / "night" / "moon_albedo.npy"

POWER = 0.95
LATITUDES, LONGITUDES = np.arange(-90, 91), np.arange(-100, 101)
"""All that libration ever shows. [deg]"""

STEP = 100.0
"""Code values to the mean of the disc."""


def read_values(path):
    """Return code values by latitude from the south and longitude from -180 deg, (row, column)."""
    pixels = OpenImageIO.ImageBuf(str(path)).get_pixels(OpenImageIO.FLOAT)
    return pixels[::-1].mean(axis=2)


def means(values):
    """Return means over cells of a degree around whole degrees."""
    height, width = values.shape
    # Sums to the left and below of each border, between pixels by interpolation.
    wide = np.concatenate([values[:, width // 2 :], values, values[:, : width // 2]], axis=1)
    columns = np.concatenate([np.zeros((height, 1)), np.cumsum(wide, axis=1)], axis=1)
    at = (np.stack([LONGITUDES - 0.5, LONGITUDES + 0.5]) + 360.0) / 360.0 * width
    columns = np.stack(
        [np.stack([np.interp(x, np.arange(2 * width + 1), row) for x in at]) for row in columns]
    )
    rows = np.concatenate([np.zeros((1, *columns.shape[1:])), np.cumsum(columns, axis=0)])
    at = (
        (np.clip(np.stack([LATITUDES - 0.5, LATITUDES + 0.5]), -90.0, 90.0) + 90.0) / 180.0 * height
    )
    corners = np.empty((2, LATITUDES.size, 2, LONGITUDES.size))
    for side in range(2):
        for column in range(LONGITUDES.size):
            corners[:, :, side, column] = np.interp(
                at, np.arange(height + 1), rows[:, side, column]
            )
    sums = corners[1, :, 1] - corners[0, :, 1] - corners[1, :, 0] + corners[0, :, 0]
    return sums / ((at[1] - at[0])[:, None] * width / 360.0)


def over_mean(albedo):
    """Divide by the mean over the disc at no libration, by projected area."""
    latitude, longitude = np.radians(LATITUDES)[:, None], np.radians(LONGITUDES)
    weight = np.cos(latitude) ** 2 * np.maximum(np.cos(longitude), 0.0)
    return albedo * weight.sum() / (albedo * weight).sum()


def main():
    """Write the table, shape (latitude, longitude), in hundredths of the mean."""
    albedo = over_mean(means(read_values(sys.argv[1])) ** POWER)
    np.save(TARGET, np.clip(np.round(STEP * albedo), 0, 255).astype(np.uint8))
    maria, highlands = np.percentile(albedo, [5, 80])
    print(
        f"{TARGET}: {albedo.shape}, from {albedo.min():.2f} to {albedo.max():.2f}, "
        f"{maria:.2f} to {highlands:.2f} at 5 and 80 %"
    )


if __name__ == "__main__":
    main()
