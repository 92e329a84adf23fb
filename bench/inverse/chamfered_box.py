"""A chamfered box of 26 facets, 1.0 x 1.3 x 1.9 m, of gold, aluminium, cells under glass and white paint, or of greys: convex, so nothing hides anything and
nothing lights another; the body of which much is asked that takes many curves."""
import itertools
import math

from vectors import cross, dot, unit

EDGES_M, CHAMFER_M = (1.0, 1.3, 1.9), 0.08
SIDES = ("px", "mx", "py", "my", "pz", "mz")
COLOURED = dict(zip(SIDES, ("gold", "aluminium", "cell", "paint", "gold", "cell")), edge="aluminium")
GREY = dict(zip(SIDES, ("aluminium", "foil", "cell", "silicon", "aluminium", "cell")), edge="aluminium")
LOBE = 'distribution = {{ model = "blinn_phong", m = {m} }}\n'
MATERIALS = {  # slopes from 12 deg (paint) to 2 deg (cells)
    "gold": 'index = "Au_Johnson"\nhaze = { share = 0.05 }\n' + LOBE.format(m=60),
    "aluminium": 'index = "Al_Rakic"\nhaze = { share = 0.05 }\n' + LOBE.format(m=300),
    "cell": 'index = "aSi_Pierce"\nlayers = [{ index = "NBK7_Schott", thickness_nm = 100000, coherent = false }]\nhaze = { albedo = 0.03 }\n' + LOBE.format(m=1000),
    "paint": "index = { n = 1.5, k = 0 }\nbody = { reflectance = 0.8 }\n" + LOBE.format(m=20),
    "silicon": 'index = "aSi_Pierce"\nhaze = { albedo = 0.1 }\n' + LOBE.format(m=500),
    "foil": "index = { n = 1.5, k = 0 }\nhaze = { share = 0.05 }\n" + LOBE.format(m=150),
}
MATERIAL_OF = {f"box_{name}": text for name, text in MATERIALS.items()}  # by its name in a scenario


def names(is_grey):
    """Of each group of the mesh its material."""
    return {group: f"box_{name}" for group, name in (GREY if is_grey else COLOURED).items()}


def materials_in_toml():
    return "".join(f"[material.{name}]\n{text}" for name, text in MATERIAL_OF.items())


def write_mesh(path):
    """Each corner of the box is cut to a triangle of three points, one on each of its sides; facets turn their fronts outward."""
    points, group_of = [], []
    number = {}
    for signs in itertools.product((1, -1), repeat=3):
        for side in range(3):  # the axis whose side the point lies on
            points.append([s * (edge / 2 - (0 if axis == side else CHAMFER_M)) for axis, (s, edge) in enumerate(zip(signs, EDGES_M))])
            number[signs, side] = len(points)
    facets = []
    for axis in range(3):
        others = [k for k in range(3) if k != axis]
        for sign in (1, -1):
            facets.append((SIDES[2 * axis + (sign < 0)], [number[s, axis] for s in ring(axis, sign, others)]))
    for axis in range(3):  # the edges along an axis
        a, b = (k for k in range(3) if k != axis)
        for sa, sb in itertools.product((1, -1), repeat=2):
            low, high = ({axis: end, a: sa, b: sb} for end in (-1, 1))
            low, high = (tuple(s[k] for k in range(3)) for s in (low, high))
            facets.append(("edge", [number[low, a], number[high, a], number[high, b], number[low, b]]))
    for signs in itertools.product((1, -1), repeat=3):
        facets.append(("edge", [number[signs, k] for k in range(3)]))
    lines = ["v {:.6g} {:.6g} {:.6g}".format(*p) for p in points]
    for group, corners in facets:
        if group != group_of:
            lines.append(f"usemtl {group}")
            group_of = group
        lines.append("f " + " ".join(map(str, outward(corners, points))))
    path.write_text("\n".join(lines) + "\n")


def write_other_mesh(mesh, path, area_sd, normal_sd, rng):
    """The mesh with facets that are apart, the area of each (in ln) and the components of its normal [rad] off by what is normal with these deviations. It is open, and a facet may stand before its neighbour by some
    centimetres: the box no longer hides nothing."""
    points, lines, count = [], [], 0
    for line in mesh.read_text().splitlines():
        words = line.split()
        if words[0] == "v":
            points.append([float(x) for x in words[1:]])
        elif words[0] == "f":
            corners = other_facet([points[int(k) - 1] for k in words[1:]], math.exp(area_sd * rng.gauss(0, 1)), [normal_sd * rng.gauss(0, 1) for _ in range(3)])
            lines += ["v {:.9g} {:.9g} {:.9g}".format(*p) for p in corners]
            lines.append("f " + " ".join(str(count + k + 1) for k in range(len(corners))))
            count += len(corners)
        else:
            lines.append(line)
    path.write_text("\n".join(lines) + "\n")


def other_facet(corners, area, lean):
    """Corners about their middle so that the area is so many times as large and `lean` is added to the normal."""
    middle = [sum(p[k] for p in corners) / len(corners) for k in range(3)]
    normal = unit(cross(*([b - a for a, b in zip(corners[0], end)] for end in corners[1:3])))
    out = []
    for p in corners:
        arm = [math.sqrt(area) * (a - b) for a, b in zip(p, middle)]
        along = dot(arm, lean) / (1 + dot(normal, lean))  # so that normal + lean is across all arms
        out.append([m + a - along * n for m, a, n in zip(middle, arm, normal)])
    return out


def ring(axis, sign, others):
    """The four corners of a side, in turn."""
    for a, b in ((1, 1), (-1, 1), (-1, -1), (1, -1)):
        corner = {axis: sign, others[0]: a, others[1]: b}
        yield tuple(corner[k] for k in range(3))


def outward(corners, points):
    p, q, r = (points[k - 1] for k in corners[:3])
    normal = cross(*([b - a for a, b in zip(p, end)] for end in (q, r)))
    return corners if dot(normal, p) > 0 else corners[::-1]
