"""Light as it is displayed, and how far two colours are apart."""

import numpy as np


def displayed(light):
    """Linear display light (0..1) by Nabiki's filmic curve: straight to a half, then a shoulder; of the strongest colour."""
    light = np.maximum(light, 0.0)
    strongest = np.maximum(light.max(-1, keepdims=True), 1e-9)
    shown = np.where(strongest <= 0.5, strongest, 1.0 - 0.5 * np.exp(-(strongest - 0.5) / 0.5))
    return shown * (light / strongest) ** (shown / strongest)


def srgb(light):
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055)


def luminance(light):
    return light @ np.array([0.2126, 0.7152, 0.0722])


def lab(light):
    """CIE L*a*b* (D65) of linear display light, Rec. 709 primaries."""
    to_xyz = np.array([[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]])
    t = light @ to_xyz.T / np.array([0.95047, 1.0, 1.08883])
    f = np.where(t > (6 / 29) ** 3, np.cbrt(t), t / (3 * (6 / 29) ** 2) + 4 / 29)
    return np.stack([116 * f[..., 1] - 16, 500 * (f[..., 0] - f[..., 1]), 200 * (f[..., 1] - f[..., 2])], -1)


def chroma_and_hue(colour):
    return np.hypot(colour[1], colour[2]), np.degrees(np.arctan2(colour[2], colour[1])) % 360


def apart(p, q):
    """CIE Delta E 2000 of two L*a*b* colours."""
    mean = 0.5 * (np.hypot(p[1], p[2]) + np.hypot(q[1], q[2]))
    g = 0.5 * (1 - np.sqrt(mean**7 / (mean**7 + 25.0**7)))
    (l1, c1, h1), (l2, c2, h2) = ((l, *chroma_and_hue((l, a * (1 + g), b))) for l, a, b in (p, q))
    dh = (h2 - h1 + 180) % 360 - 180 if c1 * c2 > 0 else 0.0
    l, c = 0.5 * (l1 + l2), 0.5 * (c1 + c2)
    h = (h1 + 0.5 * dh) % 360 if c1 * c2 > 0 else h1 + h2
    cos = lambda degrees: np.cos(np.radians(degrees))
    t = 1 - 0.17 * cos(h - 30) + 0.24 * cos(2 * h) + 0.32 * cos(3 * h + 6) - 0.20 * cos(4 * h - 63)
    sl = 1 + 0.015 * (l - 50) ** 2 / np.sqrt(20 + (l - 50) ** 2)
    sc, sh = 1 + 0.045 * c, 1 + 0.015 * c * t
    turn = -np.sin(np.radians(60 * np.exp(-(((h - 275) / 25) ** 2)))) * 2 * np.sqrt(c**7 / (c**7 + 25.0**7))
    x, y, z = (l2 - l1) / sl, (c2 - c1) / sc, 2 * np.sqrt(c1 * c2) * np.sin(np.radians(dh / 2)) / sh
    return np.sqrt(x * x + y * y + z * z + turn * y * z)


# Sharma, Wu and Dalal (2005), pairs 1 and 17 of their test data.
assert abs(apart((50, 2.6772, -79.7751), (50, 0, -82.7485)) - 2.0425) < 1e-4
assert abs(apart((50, 2.5, 0), (73, 25, -18)) - 27.1492) < 1e-4
