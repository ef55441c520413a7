"""A ray tracer in plain Python: the picture's formulas, in floats of 64 bits."""

import json
import math
import struct
import sys


def add(a, b):
    return [x + y for x, y in zip(a, b)]


def subtract(a, b):
    return [x - y for x, y in zip(a, b)]


def scale(s, a):
    return [s * x for x in a]


def times(a, b):
    return [x * y for x, y in zip(a, b)]


def dot(a, b):
    return sum(times(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    return scale(1 / math.sqrt(dot(a, a)), a)


def read_scene(path):
    scene = {"surface": None, "sphere": [], "tetrahedron": []}
    table = scene
    for line in open(path):
        line = line.strip()
        if line.startswith("[["):
            table = {}
            scene[line.strip("[]")].append(table)
        elif line.startswith("["):
            table = scene[line.strip("[]")] = {}
        elif line:
            key, value = line.split(" = ")
            table[key] = json.loads(value)
    return scene


def meet_sphere(sphere, origin, direction):
    """Where a line enters and leaves a sphere, and the normal where it enters."""
    away = subtract(origin, sphere["center"])
    a, b = dot(direction, direction), dot(direction, away)
    discriminant = b * b - a * (dot(away, away) - sphere["radius"] ** 2)
    if discriminant < 0:
        return None
    enter, leave = (-b - math.sqrt(discriminant)) / a, (-b + math.sqrt(discriminant)) / a
    return enter, leave, unit(add(away, scale(enter, direction)))


def meet_tetrahedron(tetrahedron, origin, direction):
    """The same for a tetrahedron: a line has entered it when it is behind all of its faces."""
    enter, leave, normal = -math.inf, math.inf, None
    for face in range(4):
        opposite, a, b, c = (tetrahedron["vertices"][(face + k) % 4] for k in range(4))
        outward = unit(cross(subtract(b, a), subtract(c, a)))
        if dot(outward, subtract(opposite, a)) > 0:
            outward = scale(-1, outward)
        outside, speed = dot(outward, subtract(origin, a)), dot(outward, direction)
        if speed < 0 and -outside / speed > enter:
            enter, normal = -outside / speed, outward
        elif speed > 0:
            leave = min(leave, -outside / speed)
        elif speed == 0 and outside > 0:
            return None
    return (enter, leave, normal) if enter <= leave else None


class Picture:
    def __init__(self, request):
        self.stage, self.alpha, self.size = request["stage"], request["alpha"], request["size"]
        self.scene = read_scene(request["scene"])
        material, light = self.scene["material"], self.scene["light"]
        self.ambient = times(material["ambient"], light["ambient_intensity"])
        self.diffuse = times(material["diffuse"], light["intensity"])
        self.specular = times(material["specular"], light["intensity"])
        self.to_light = unit(scale(-1, light["direction"]))
        self.solids = [(meet_sphere, sphere) for sphere in self.scene["sphere"]]
        self.solids += [(meet_tetrahedron, solid) for solid in self.scene["tetrahedron"]]

    def first_hit(self, origin, direction, ahead):
        """The first solid that a line meets, or a ray ahead: t, the normal, the solid."""
        first = None
        for meet, solid in self.solids:
            takes_part = {2: meet_sphere, 3: meet_tetrahedron}.get(self.stage, meet) is meet
            met = meet(solid, origin, direction) if takes_part else None
            if met and (met[1] > 0 or not ahead) and (not first or met[0] < first[0]):
                first = met[0], met[2], solid
        return first

    def is_hidden(self, point, but=None):
        """Whether a solid but this one stands between a point and the light."""
        for meet, solid in self.solids:
            if solid is not but:
                met = meet(solid, point, self.to_light)
                if met and met[1] > 0:
                    return True
        return False

    def meet_surface(self, origin, direction):
        surface = self.scene["surface"]
        if surface is None or self.stage < 5:
            return None
        t = (surface["height"] - origin[1]) / direction[1]
        x, _, z = add(origin, scale(t, direction))
        return t if max(abs(x), abs(z)) <= surface["half_width"] else None

    def shade(self, origin, direction, hit):
        """Equation 4-1."""
        t, normal, solid = hit
        point = add(origin, scale(t, direction))
        normal_light = dot(normal, self.to_light)
        light = self.ambient
        if self.stage >= 5:
            under = self.meet_surface(point, self.to_light)
            in_shadow = normal_light <= 0 or self.is_hidden(point, solid) or (under or 0) > 0
            if in_shadow:
                return times(solid["color"], light)
        halfway = unit(subtract(self.to_light, unit(direction)))
        highlight = max(0, dot(normal, halfway)) ** self.scene["material"]["exponent"]
        light = add(light, scale(max(0, normal_light), self.diffuse))
        return times(solid["color"], add(light, scale(highlight, self.specular)))

    def surface_at(self, origin, direction, t):
        surface = self.scene["surface"]
        x, _, z = add(origin, scale(t, direction))
        point = [x, surface["height"], z]
        if self.is_hidden(point):
            return self.ambient
        if self.stage >= 6:
            mirrored = [direction[0], -direction[1], direction[2]]
            hit = self.first_hit(point, mirrored, True)
            if hit:
                return scale(surface["reflectance"], self.shade(point, mirrored, hit))
        return surface["color"]

    def pixel(self, x, y):
        half = self.size / 2
        if self.stage == 1:
            if x <= half:
                return [0.3, 0.3, 0] if y <= half else [0, 0.3, 0.3]
            return [0.3, 0, 0.3] if y <= half else [0, 0, 0]
        u, v = (x - half) / half, (y - half) / half
        sin, cos = math.sin(self.alpha), math.cos(self.alpha)
        origin, direction = [sin + u * cos, v, cos - u * sin], [-sin, -0.3, -cos]
        hit = self.first_hit(origin, direction, False)
        t = self.meet_surface(origin, direction)
        if t is not None and not (hit and hit[0] <= t):
            return self.surface_at(origin, direction, t)
        if not hit:
            return self.scene["background"]
        return hit[2]["color"] if self.stage < 4 else self.shade(origin, direction, hit)


for line in sys.stdin:
    picture = Picture(json.loads(line))
    for y in range(picture.size):
        for x in range(picture.size):
            sys.stdout.buffer.write(struct.pack("<3f", *picture.pixel(x, y)))
    sys.stdout.buffer.flush()
