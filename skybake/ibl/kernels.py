"""The loops over texels, compiled; single precision, serial, each row of its own."""

from __future__ import annotations

import math

import numpy as np

from skybake.jit.kernel import kernel

_ONE, _HALF, _ZERO = np.float32(1.0), np.float32(0.5), np.float32(0.0)


@kernel
def fill_filtered(normals, texels, starts, edges, vectors, weights, levels, out):
    """Write the weighted mean of samples about each normal.

    Parameters
    ----------
    normals, out : ndarray of float32, shape (n, 3)
        Unit vectors, and what is written.
    texels : ndarray of float32, shape (texel, 3)
        The levels of a pyramid one after another, each six faces with borders of a texel.
    starts, edges : ndarray of int64, shape (level,)
        First texel of each level, and edge of its faces without the border.
    vectors, weights, levels
        As of `skybake.ibl.lobe.Samples`.
    """
    for i in range(normals.shape[0]):
        nx, ny, nz = normals[i, 0], normals[i, 1], normals[i, 2]
        # A frame that turns nowhere but at -Z (Duff et al. 2017).
        sign = _ONE if nz >= _ZERO else -_ONE
        a = -_ONE / (sign + nz)
        b = nx * ny * a
        rx, ry, rz = _ONE + sign * nx * nx * a, sign * b, -sign * nx
        ux, uy, uz = b, sign + ny * ny * a, -ny
        red, green, blue = _ZERO, _ZERO, _ZERO
        for j in range(weights.size):
            lx, ly, lz = vectors[j, 0], vectors[j, 1], vectors[j, 2]
            x = lx * rx + ly * ux + lz * nx
            y = lx * ry + ly * uy + lz * ny
            z = lx * rz + ly * uz + lz * nz
            ax, ay, az = abs(x), abs(y), abs(z)
            if ax >= ay and ax >= az:
                face = 0 if x > _ZERO else 1
                u, v, forward = -z if x > _ZERO else z, -y, ax
            elif ay >= az:
                face = 2 if y > _ZERO else 3
                u, v, forward = x, z if y > _ZERO else -z, ay
            else:
                face = 4 if z > _ZERO else 5
                u, v, forward = x if z > _ZERO else -x, -y, az
            edge = edges[levels[j]]
            scale = _HALF * np.float32(edge) / forward
            middle = _HALF * np.float32(edge + 1)
            column, row = u * scale + middle, v * scale + middle
            left, top = int(column), int(row)
            across, down = column - np.float32(left), row - np.float32(top)
            stride = edge + 2
            upper = starts[levels[j]] + (face * stride + top) * stride + left
            lower = upper + stride
            weight = weights[j]
            w11 = weight * across * down
            w10 = weight * across - w11
            w01 = weight * down - w11
            w00 = weight - w11 - w10 - w01
            red += (
                w00 * texels[upper, 0]
                + w10 * texels[upper + 1, 0]
                + w01 * texels[lower, 0]
                + w11 * texels[lower + 1, 0]
            )
            green += (
                w00 * texels[upper, 1]
                + w10 * texels[upper + 1, 1]
                + w01 * texels[lower, 1]
                + w11 * texels[lower + 1, 1]
            )
            blue += (
                w00 * texels[upper, 2]
                + w10 * texels[upper + 1, 2]
                + w01 * texels[lower, 2]
                + w11 * texels[lower + 1, 2]
            )
        out[i, 0], out[i, 1], out[i, 2] = red, green, blue


@kernel
def add_lobes(normals, directions, flux, squared, scale, out):
    """Add to each normal what its lobe gathers of points of light.

    Parameters
    ----------
    normals, out : ndarray of float32, shape (n, 3)
        Unit vectors, and what is added to.
    directions, flux : ndarray of float32, shape (3, point)
        Unit vectors, and irradiances on planes that face them.
    squared, scale : ndarray of float32, shape (1,)
        Square of GGX's width, and that square over pi and the lobe's total.
    """
    a, s = squared[0], scale[0]
    b = _HALF * (_ONE - a)
    for i in range(normals.shape[0]):
        nx, ny, nz = normals[i, 0], normals[i, 1], normals[i, 2]
        red, green, blue = out[i, 0], out[i, 1], out[i, 2]
        for j in range(directions.shape[1]):
            dx, dy, dz = directions[0, j] - nx, directions[1, j] - ny, directions[2, j] - nz
            # 1 - n.l, without cancellation
            short = _HALF * (dx * dx + dy * dy + dz * dz)
            cosine = max(_ONE - short, _ZERO)
            width = a + b * short
            weight = s * cosine / (width * width)
            red += weight * flux[0, j]
            green += weight * flux[1, j]
            blue += weight * flux[2, j]
        out[i, 0], out[i, 1], out[i, 2] = red, green, blue


@kernel
def fill_irradiance(normals, moments, signs, out):
    """Write the irradiance of planes that face each normal.

    Parameters
    ----------
    normals, out : ndarray of float32, shape (n, 3)
        Unit vectors, and what is written; n is a multiple of 4.
    moments : ndarray of float32, shape (3, 3, source)
        By channel and axis: integral of light times direction over each source, times its sign.
    signs : ndarray of float32, shape (3, source)
        Whether light is positive, 1, or negative, -1.
    """
    for i in range(0, normals.shape[0], 4):
        # Sources are read once for four normals.
        ax, ay, az = normals[i, 0], normals[i, 1], normals[i, 2]
        bx, by, bz = normals[i + 1, 0], normals[i + 1, 1], normals[i + 1, 2]
        cx, cy, cz = normals[i + 2, 0], normals[i + 2, 1], normals[i + 2, 2]
        dx, dy, dz = normals[i + 3, 0], normals[i + 3, 1], normals[i + 3, 2]
        for channel in range(3):
            x, y, z = moments[channel, 0], moments[channel, 1], moments[channel, 2]
            sign = signs[channel]
            a, b, c, d = _ZERO, _ZERO, _ZERO, _ZERO
            for j in range(sign.size):
                mx, my, mz, s = x[j], y[j], z[j], sign[j]
                a += s * max(ax * mx + ay * my + az * mz, _ZERO)
                b += s * max(bx * mx + by * my + bz * mz, _ZERO)
                c += s * max(cx * mx + cy * my + cz * mz, _ZERO)
                d += s * max(dx * mx + dy * my + dz * mz, _ZERO)
            out[i, channel], out[i + 1, channel] = a, b
            out[i + 2, channel], out[i + 3, channel] = c, d


@kernel
def fill_dfg(first_row, rings, cosines, out):
    """Write rows of the split sum's table.

    Parameters
    ----------
    first_row : int
        Number of the first one.
    rings, cosines : ndarray of float64
        Roots of the shares of half vectors that are farther from the normal, evenly spaced, and
        cosines of their turns about it.
    out : ndarray of float32, shape (row, edge, 2)
        Scale and bias.
    """
    edge = out.shape[1]
    for i in range(out.shape[0]):
        roughness = (first_row + i + 0.5) / edge
        a = roughness**4
        for j in range(edge):
            view = (j + 0.5) / edge
            across = math.sqrt(1.0 - view * view)
            scale, bias = 0.0, 0.0
            for ring in rings:
                # The share of half vectors beyond a ring is its square, since they weigh as the
                # inverse of their height.
                beyond = ring * ring
                squared = beyond / (1.0 + (a - 1.0) * (1.0 - beyond))
                height, aside = math.sqrt(squared), math.sqrt(1.0 - squared)
                for cosine in cosines:
                    meeting = view * height + across * aside * cosine
                    light = 2.0 * meeting * height - view
                    if light <= 0.0 or meeting <= 0.0:
                        continue
                    shadowing = light * math.sqrt(view * view * (1.0 - a) + a)
                    shadowing += view * math.sqrt(light * light * (1.0 - a) + a)
                    weight = 4.0 * ring * light * meeting / (shadowing * height)
                    rest = 1.0 - meeting
                    fresnel = rest * rest
                    fresnel *= fresnel * rest
                    scale += (1.0 - fresnel) * weight
                    bias += fresnel * weight
            count = rings.size * cosines.size
            out[i, j, 0], out[i, j, 1] = scale / count, bias / count
