"""A ray tracer written from "Computer Graphics and Programming, Lecture 11, Ray Tracing".

    python3 tracer.py scene.txt image.pfm

Reads raycheck's text scenes, writes linear RGB as PFM. One file, no library.
"""

import array
import math
import sys

EPS = 2e-3  # nearer hits are taken for the surface the ray starts on
INFINITE = math.inf


# ---------------------------------------------------------------- vectors and colours
def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def neg(a):
    return (-a[0], -a[1], -a[2])


def scale(a, s):
    return (a[0] * s, a[1] * s, a[2] * s)


def mul(a, b):
    return (a[0] * b[0], a[1] * b[1], a[2] * b[2])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def length(a):
    return math.sqrt(dot(a, a))


def unit(a):
    size = length(a)
    return scale(a, 1 / size) if size > 0 else a


BLACK = (0.0, 0.0, 0.0)


# ---------------------------------------------------------------- the scene
class Material:
    def __init__(self, n):
        self.ambient, self.diffuse, self.specular = tuple(n[0:3]), tuple(n[3:6]), tuple(n[6:9])
        self.shininess = n[9]
        self.reflect, self.transmit = tuple(n[10:13]), tuple(n[13:16])
        self.index = n[16]


class Thing:
    def __init__(self, shape, numbers, material):
        self.sphere = shape == "sphere"
        self.v = tuple(numbers[0:3])  # centre of a sphere, normal of a plane
        self.s = numbers[3]  # radius of a sphere, offset of a plane
        self.material = material


class Light:
    def __init__(self, kind, words):
        self.point = kind == "point"
        numbers = [float(word) for word in words[0:6]]
        self.v = tuple(numbers[0:3])  # position of a point light, direction towards a directional one
        self.color = tuple(numbers[3:6])
        self.attenuation = words[6] if self.point else "none"


class Scene:
    def __init__(self, path):
        self.things, self.lights = [], []
        materials = {}
        with open(path, encoding="utf-8") as file:
            for line in file:
                words = line.split()
                if words and not words[0].startswith("#"):
                    self.statement(words[0], words[1:], materials)

    def statement(self, word, rest, materials):
        if word == "image":
            self.width, self.height = int(rest[0]), int(rest[1])
            self.sx, self.sy = float(rest[2]), float(rest[3])
        elif word in ("eye", "forward", "right", "up", "background"):
            setattr(self, word, tuple(float(number) for number in rest))
        elif word in ("depth", "shadows", "fresnel"):
            setattr(self, word, int(rest[0]))
        elif word == "material":
            materials[rest[0]] = Material([float(number) for number in rest[1:]])
        elif word in ("sphere", "plane"):
            self.things.append(Thing(word, [float(number) for number in rest[:4]], materials[rest[4]]))
        elif word in ("point", "directional"):
            self.lights.append(Light(word, rest))
        elif word not in ("raycheck", "display", "end"):
            sys.exit(f"unknown statement {word}")


# ---------------------------------------------------------------- the lecture's formulas
def ray(s, i, j):
    """Ray Vector Calculation."""
    # [open] the direction through pixel (i, j), unit: return s.forward
    x = -1 + 2 * (i + s.sx) / s.width
    y = 1 - 2 * (j + s.sy) / s.height
    return unit(add(s.forward, add(scale(s.right, x), scale(s.up, y))))
    # [close]


def distance(thing, o, v):
    """Sphere Intersection; a plane from normal.p = offset. Infinite: no hit."""
    if not thing.sphere:
        # [open] the distance to a plane: return INFINITE
        toward = dot(thing.v, v)
        if toward == 0:
            return INFINITE
        t = (thing.s - dot(thing.v, o)) / toward
        return t if t > EPS else INFINITE
        # [close]
    # [open] the smallest distance beyond EPS to a sphere: return INFINITE
    b = sub(o, thing.v)
    bv = dot(b, v)
    d = bv * bv - (dot(b, b) - thing.s * thing.s)
    if d < 0:
        return INFINITE
    root = math.sqrt(d)
    if -bv - root > EPS:
        return -bv - root
    if -bv + root > EPS:
        return -bv + root
    return INFINITE
    # [close]


def normal(thing, p):
    # [open] the outward unit normal at p: return (0.0, 0.0, 1.0)
    return unit(sub(p, thing.v)) if thing.sphere else unit(thing.v)
    # [close]


def reflection(i, n):
    """Math of Reflection Vector."""
    # [open] the mirror direction of i about n: return i
    return sub(scale(n, 2 * dot(i, n)), i)
    # [close]


def refraction(v, n, leaving, index):
    """Refraction Vector Calculation, entering and leaving; None under total internal reflection."""
    # [open] Snell's law; n faces the ray: return None
    p = sub(v, scale(n, dot(v, n)))
    s = scale(p, index) if leaving else scale(p, 1 / index)
    sin2 = dot(s, s)
    if sin2 >= 1:
        return None
    return unit(sub(s, scale(n, math.sqrt(1 - sin2))))
    # [close]


def fresnel(v, n, leaving, index):
    """Reflected share at a dielectric (only for scenes that ask for it)."""
    # [open] the exact dielectric formula: return 1.0
    n1, n2 = (index, 1) if leaving else (1, index)
    c1 = -dot(v, n)
    sin2 = (n1 / n2) * (n1 / n2) * (1 - c1 * c1)
    if sin2 >= 1:
        return 1.0
    c2 = math.sqrt(1 - sin2)
    rs = (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2)
    rp = (n2 * c1 - n1 * c2) / (n2 * c1 + n1 * c2)
    return (rs * rs + rp * rp) / 2
    # [close]


def shadowed(s, p, i, light):
    # [open] does anything stand between p and the light: return False
    return any(distance(thing, p, i) < light for thing in s.things)
    # [close]


def local_colour(s, m, p, n, v):
    """Phong Effect."""
    c = m.ambient
    # [open] add each light's diffuse and specular part to c: pass
    for light in s.lights:
        w = sub(light.v, p) if light.point else light.v
        i = unit(w)
        cosine = dot(i, n)
        if cosine <= 0:
            continue
        d = length(w) if light.point else INFINITE
        if s.shadows and shadowed(s, p, i, d):
            continue
        a = {"none": 1, "inverse": 1 / d, "inverse_square": 1 / (d * d)}[light.attenuation]
        gloss = dot(reflection(i, n), neg(v))
        gloss = gloss**m.shininess if gloss > 0 else 0.0
        c = add(c, mul(scale(light.color, a), add(scale(m.diffuse, cosine), scale(m.specular, gloss))))
    # [close]
    return c


def find_rgb(s, o, v, generation):
    """Modified FindRGB, Refraction with geo.tr vector."""
    nearest, fmin = None, INFINITE
    # [open] find the nearest thing and its distance fmin: pass
    for thing in s.things:
        f = distance(thing, o, v)
        if f < fmin:
            nearest, fmin = thing, f
    # [close]
    if nearest is None:
        return s.background

    m = nearest.material
    p = add(o, scale(v, fmin))
    n = normal(nearest, p)
    leaving = dot(n, v) > 0
    if leaving:
        n = neg(n)
    colour = local_colour(s, m, p, n, v)
    if generation == s.depth:
        return colour

    # [open] add the mirrored and the refracted ray's colours: pass
    share = fresnel(v, n, leaving, m.index) if s.fresnel else None
    if m.reflect != BLACK:
        keep = 1 if share is None else share
        mirrored = find_rgb(s, p, reflection(neg(v), n), generation + 1)
        colour = add(colour, scale(mul(m.reflect, mirrored), keep))
    if m.transmit != BLACK:
        t = refraction(v, n, leaving, m.index)
        if t is not None:
            through = 1 if share is None else 1 - share
            colour = add(colour, scale(mul(m.transmit, find_rgb(s, p, t, generation + 1)), through))
    # [close]
    return colour


# ---------------------------------------------------------------- the picture
def write_pfm(path, width, height, rows):
    with open(path, "wb") as file:
        file.write(b"PF\n%d %d\n%s\n" % (width, height, b"-1.0" if sys.byteorder == "little" else b"1.0"))
        for row in reversed(rows):  # PFM stores the bottom row first
            array.array("f", [value for colour in row for value in colour]).tofile(file)


def main():
    if len(sys.argv) != 3:
        sys.exit("usage: tracer.py scene.txt image.pfm")
    s = Scene(sys.argv[1])
    rows = [[find_rgb(s, s.eye, ray(s, i, j), 0) for i in range(s.width)] for j in range(s.height)]
    write_pfm(sys.argv[2], s.width, s.height, rows)


main()
