"""What is compared: views, colours, lamps, and the regions in which the two are held against each other."""

from dataclasses import dataclass, field

SIZE = (480, 360)

# Azimuth from the camera and elevation (degrees), strength, colour, extent (degrees). By these lamps, all, the sky or the key alone,
# what docs/rendering.md calls fitted was chosen.
KEY = (30.0, 42.0, 2.9, (1.0, 0.97, 0.93), 4.0)
FILL = (-50.0, 15.0, 0.6, (0.94, 0.97, 1.0), 20.0)
RIM = (-155.0, 38.0, 0.9, (1.0, 0.97, 0.94), 4.0)
SKY = 0.32
# The light that scenes have unless they say otherwise, as `Light::studio` and `Sky` of nabiki_render have it: nothing was chosen by it.
STUDIO = [
    (32.0, 48.0, 3.1, (1.0, 0.96, 0.91), 6.0),
    (-50.0, 14.0, 0.5, (0.92, 0.96, 1.0), 20.0),
    (168.0, 40.0, 1.0, (1.0, 0.97, 0.94), 9.0),
    (-130.0, 28.0, 0.85, (0.92, 0.96, 1.0), 9.0),
]
STUDIO_SKY = 0.24
ABOVE, BELOW = (0.93, 0.97, 1.0), (0.55, 0.5, 0.47)
SKIN = (0.56, 0.44, 0.37)

# Hair as the scenes have it unless a view says otherwise.
WIDTH, TIP, TAPER = 0.0085, 0.1, 0.4
VARIATION, ROUGHNESS, AROUND, TILT, REFRACTION = 0.25, 5.0, 0.35, 2.5, 1.55
# Eumelanin and pheomelanin of the named colours.
MELANIN = {"black": (8.0, 0.0), "brown": (1.1, 0.6), "blond": (0.03, 0.2), "red": (0.0, 1.9)}


@dataclass(frozen=True)
class View:
    """A frame of a scene through a camera. Regions are rectangles (left, top, right, bottom; pixels); of one whose name begins with
    "skin" the head's pixels count, of the others those of which hair covers most."""

    name: str
    scene: str
    frame: int
    azimuth: float
    elevation: float
    target: tuple
    distance: float
    regions: dict
    width: float = WIDTH
    tip: float = TIP
    fov: float = 26.0


@dataclass(frozen=True)
class Case:
    view: View
    colour: str
    light: str = "all"  # or "sky", "key" or "studio"

    @property
    def name(self):
        return f"{self.view.name}-{self.colour}" + ("" if self.light == "all" else f"-{self.light}")

    @property
    def lamps(self):
        return {"all": [KEY, FILL, RIM], "sky": [], "key": [KEY], "studio": STUDIO}[self.light]

    @property
    def sky(self):
        return {"key": 0.0, "studio": STUDIO_SKY}.get(self.light, SKY)


GUST = View(
    "gust0", "gust", 0, 60.0, 4.0, (-1.0, -3.0, 0.0), 80.0,
    {
        "top": (210, 44, 262, 70),
        "band": (160, 110, 198, 158),
        "side": (204, 110, 238, 190),
        "edge": (230, 120, 246, 180),
        "tips": (176, 235, 232, 268),
        "rim": (138, 193, 155, 283),
        "skin cheek": (273, 150, 312, 225),
        "skin jaw": (255, 254, 305, 266),
        "skin neck": (240, 292, 266, 318),
    },
)
BLOWN = View(
    "gust36", "gust", 36, 60.0, 4.0, (-4.5, -3.0, 0.0), 86.0,
    {
        "top": (239, 48, 294, 72),
        "side": (183, 96, 239, 152),
        "strands": (142, 145, 176, 179),
        "tips": (128, 228, 176, 259),
        "rim": (149, 62, 190, 89),
        "skin cheek": (259, 179, 308, 228),
        "skin neck": (204, 242, 239, 283),
    },
)
BOB = View(
    "bob22", "bob", 22, 35.0, 4.0, (-1.0, 1.0, 0.0), 80.0,
    {
        "top": (190, 99, 232, 134),
        "fringe": (232, 120, 308, 168),
        "low fringe": (228, 160, 315, 172),
        "far lock": (142, 161, 183, 231),
        "tips": (121, 258, 176, 283),
        "skin nape": (183, 279, 204, 334),
        "skin cheek": (232, 238, 273, 279),
    },
)
SHORT = View(
    "short12", "short", 12, 35.0, 6.0, (0.0, -1.0, 0.0), 70.0,
    {
        "top": (176, 68, 225, 96),
        "side": (149, 110, 183, 145),
        "sideburn": (169, 159, 183, 186),
        "skin cheek": (204, 214, 252, 262),
        "skin neck": (176, 290, 211, 325),
    },
)
FINE = View(
    "fifty0", "fifty_thousand", 0, 50.0, 6.0, (-2.0, -4.0, 0.0), 75.0,
    {
        "top": (225, 30, 280, 50),
        "band": (169, 85, 211, 134),
        "side": (162, 168, 225, 245),
        "tips": (155, 279, 225, 314),
        "skin cheek": (259, 168, 301, 238),
        "skin neck": (239, 279, 273, 321),
    },
    width=0.011,
    tip=0.3,
)
# Hair that points at the eye, over hair that lies.
ON_END = View(
    "storm128", "storm", 128, 200.0, 5.0, (-2.0, -3.0, 0.0), 76.0,
    {"ends": (255, 150, 300, 250), "top": (240, 60, 290, 90), "lying": (175, 95, 225, 115)},
)

CASES = [
    Case(GUST, "brown"),
    Case(GUST, "blond"),
    Case(GUST, "black"),
    Case(GUST, "red"),
    Case(GUST, "brown", "sky"),
    Case(GUST, "blond", "key"),
    Case(GUST, "blond", "sky"),
    Case(GUST, "brown", "key"),
    Case(BLOWN, "brown"),
    Case(BLOWN, "blond"),
    Case(BOB, "blond"),
    Case(BOB, "brown"),
    Case(SHORT, "brown"),
    Case(FINE, "black"),
    Case(GUST, "red", "studio"),
    Case(GUST, "brown", "studio"),
    Case(BOB, "blond", "studio"),
    Case(FINE, "black", "studio"),
    Case(ON_END, "brown", "studio"),
]
