"""scenes/t_handle.obj: a T-handle as one closed mesh, and what it weighs by closed forms.

A hub (a box) carries a bar of two prisms along x and a stem, a prism along -y; every prism is a regular
n-gon, joined to the hub's face by a ring of triangles between the face's outline and the prism's. Lengths
are centimetres: the scene scales by 0.01.

The reference beside it (t_handle.csv) knows nothing of triangles: a box and three regular prisms, each by
its closed form, joined by the parallel axis theorem.

    regular n-gon of circumradius r:  A = n/2 r² sin(2π/n),  ∫ u² = ∫ v² = A r² (2 + cos(2π/n)) / 12
    prism of length l along w:        V = A l,  ∫ w² = V l²/12 about its middle

    python t_handle.py      writes ../../scenes/t_handle.obj and t_handle.csv
"""

from pathlib import Path

from mpmath import cos, mp, mpf, nstr, pi, sin

mp.dps = 40
HERE = Path(__file__).resolve().parent
N = 32
HUB = mpf("1.2")  # half its edge
# name, axis, side, radius, length
PRISMS = [("bar", 0, 1, mpf(1), mpf(4)), ("bar", 0, -1, mpf(1), mpf(4)), ("stem", 1, -1, mpf("0.8"), mpf(5))]


class Mesh:
    def __init__(self):
        self.points, self.index, self.faces = [], {}, []

    def vertex(self, p):
        # A cosine of a right angle is 0, on whichever face it is computed.
        key = tuple(float(x) if abs(x) > 1e-30 else 0.0 for x in p)
        if key not in self.index:
            self.index[key] = len(self.points) + 1
            self.points.append(key)
        return self.index[key]

    def face(self, corners, outward):
        """A convex flat face, its corners put in the order that is counter-clockwise from outside."""
        # Newell's normal: three corners may lie on a line.
        n = [mpf(0)] * 3
        for p, q in zip(corners, corners[1:] + corners[:1]):
            for i in range(3):
                j, k = (i + 1) % 3, (i + 2) % 3
                n[i] += p[j] * q[k] - p[k] * q[j]
        if sum(x * y for x, y in zip(n, outward)) < 0:
            corners = corners[::-1]
        self.faces.append([self.vertex(p) for p in corners])


def frame(axis, side):
    """Turns (along, u, v) into x, y, z."""
    u, v = (axis + 1) % 3, (axis + 2) % 3

    def place(along, a, b):
        p = [mpf(0)] * 3
        p[axis], p[u], p[v] = side * along, a, b
        return tuple(p)

    return place


def on_square(a, b):
    """The point of the square of half edge HUB in the direction of (a, b), corners at odd eighths."""
    size = max(abs(a), abs(b))
    return a / size * HUB, b / size * HUB


def build():
    mesh = Mesh()
    turn = [(cos(2 * pi * k / N), sin(2 * pi * k / N)) for k in range(N)]
    # Rounded, so that corners of the square are the same for every face that has them.
    square = [tuple(mpf(nstr(x, 17)) for x in on_square(*t)) for t in turn]
    used = {(axis, side) for _, axis, side, _, _ in PRISMS}
    for axis in range(3):
        for side in (1, -1):
            place = frame(axis, side)
            outward = place(1, 0, 0)
            outline = [place(HUB, *square[k]) for k in range(N)]
            if (axis, side) not in used:
                mesh.face(outline, outward)
    for _, axis, side, radius, length in PRISMS:
        place = frame(axis, side)
        outward = place(1, 0, 0)
        ring = [(radius * c, radius * s) for c, s in turn]
        for k in range(N):
            j = (k + 1) % N
            near = [place(HUB, *ring[i]) for i in (k, j)]
            far = [place(HUB + length, *ring[i]) for i in (k, j)]
            mesh.face([near[0], near[1], place(HUB, *square[j]), place(HUB, *square[k])], outward)
            middle = place(0, *(ring[k][i] + ring[j][i] for i in range(2)))
            mesh.face([near[0], near[1], far[1], far[0]], middle)
        mesh.face([place(HUB + length, *ring[k]) for k in range(N)], outward)
    return mesh


def reference():
    """Volume (cm³), centre of mass, moments about it at unit density (cm⁵): the T's axes are principal."""
    parts = [(8 * HUB**3, [mpf(0)] * 3, [8 * HUB**3 * HUB**2 / 3] * 3)]
    for _, axis, side, r, length in PRISMS:
        area = N * r**2 * sin(2 * pi / N) / 2
        volume = area * length
        squares = [volume * r**2 * (2 + cos(2 * pi / N)) / 12] * 3
        squares[axis] = volume * length**2 / 12
        centre = [mpf(0)] * 3
        centre[axis] = side * (HUB + length / 2)
        parts.append((volume, centre, squares))
    volume = sum(p[0] for p in parts)
    centre = [sum(p[0] * p[1][i] for p in parts) / volume for i in range(3)]
    squares = [sum(p[2][i] + p[0] * (p[1][i] - centre[i]) ** 2 for p in parts) for i in range(3)]
    return volume, centre, [sum(squares) - s for s in squares]


def main():
    mesh = build()
    lines = [
        "# A T-handle: bar along x, stem along -y, from a hub; one closed shell. Centimetres.",
        "# Written by tests/oracles/t_handle.py.",
        *("v " + " ".join(map(repr, p)) for p in mesh.points),
        *("f " + " ".join(map(str, f)) for f in mesh.faces),
    ]
    (HERE.parent.parent / "scenes" / "t_handle.obj").write_text("\n".join(lines) + "\n")
    volume, centre, moments = reference()
    row = [volume, *centre, *moments]
    text = "volume,centre_x,centre_y,centre_z,i_x,i_y,i_z\n" + ",".join(nstr(x, 25) for x in row) + "\n"
    (HERE / "t_handle.csv").write_text(text)
    print(text, len(mesh.points), "vertices", len(mesh.faces), "faces")


main()
