# SPDX-License-Identifier: Apache-2.0
"""The drawings of docs/physics.md."""

import itertools
import math

from svg import CORAL, GOLD, GRAY, INK, PALE, TEAL, VIOLET, WATER, Drawing


def muscle():
    """A spring between two masses, and its rest length over time."""
    d = Drawing(860, 270)
    a, b = (90, 110), (310, 110)
    d.spring(a, b)
    d.mass(a)
    d.mass(b)
    d.text((90, 90), "1 kg")
    d.text((310, 90), "1 kg")
    d.dimension((90, 150), (310, 150), "|d|", offset=-8)
    d.arrow((102, 110), (152, 110), TEAL)
    d.arrow((298, 110), (248, 110), TEAL)
    d.text((200, 80), "*F = k* (|d| - *L*)", color=TEAL)
    d.text((200, 205), "stretched beyond its rest length, a spring pulls", 14, GRAY)
    d.text((200, 225), "pressed below it, it pushes", 14, GRAY)

    left, right, middle, swing = 470, 820, 118, 55
    d.arrow((left, 215), (left, 40), INK, 1.4)
    d.arrow((left, 215), (right + 15, 215), INK, 1.4)
    d.line((left, middle), (right, middle), GRAY, 1.2, "4 5")
    curve = [(left + x, middle - swing * math.sin(2 * math.pi * x / 210 + 0.7)) for x in range(0, right - left, 3)]
    d.path(curve, CORAL, 2.6)
    d.text((left - 14, 46), "*L*")
    d.text((right + 12, 235), "*t*")
    d.text((left - 18, middle + 5), "*L*_0")
    top = left + 210 * (0.25 - 0.7 / (2 * math.pi))
    d.dimension((top + 105, middle), (top + 105, middle + swing), "")
    d.text((top + 105, middle + swing + 20), "*L*_0 Δ*L*_0", size=14)
    second = top + 210
    d.line((top, middle - swing - 6), (top, 42), GRAY, 1, "2 4")
    d.line((second, middle - swing - 6), (second, 42), GRAY, 1, "2 4")
    d.dimension((top, 48), (second, 48), "2π / ω", offset=-8)
    d.text((645, 256), "*L*(*t*) = *L*_0 (1 + Δ*L*_0 sin(ω*t* + φ))", 16, CORAL)
    return d


def face():
    """The water's force on one triangle of the skin."""
    d = Drawing(860, 330)
    a, b, c = (150, 235), (330, 265), (265, 105)
    center = (sum(p[0] for p in (a, b, c)) / 3, sum(p[1] for p in (a, b, c)) / 3)
    for y in (70, 130, 190, 250):
        d.arrow((22, y), (82, y + 8), "#a9cbe4", 2)
    d.text((30, 45), "water, relative to the face", 14, WATER, anchor="start")
    d.path([a, b, c], INK, 1.8, fill="#f7d9cd", closed=True)
    for p in (a, b, c):
        d.mass(p, 8)
    d.text((132, 252), "*a*")
    d.text((342, 285), "*b*")
    d.text((262, 92), "*c*")
    normal, flow = (0.86, -0.51), (0.99, 0.13)
    d.arrow((center[0] - 120 * flow[0], center[1] - 120 * flow[1]), center, WATER, 2.4)
    d.text((160, 172), "*u*", 17, WATER)
    d.arrow(center, (center[0] + 95 * normal[0], center[1] + 95 * normal[1]), GRAY, 2)
    d.text((center[0] + 84 * normal[0] - 10, center[1] + 88 * normal[1] - 12), "*n*", 17, GRAY)
    drag = (center[0] + 150 * flow[0], center[1] + 150 * flow[1])
    d.arrow(center, drag, TEAL, 2.4)
    d.text((drag[0] + 4, drag[1] + 22), "drag", 14, TEAL)
    total = (drag[0] + 42 * normal[0], drag[1] + 42 * normal[1])
    d.arrow(drag, total, GOLD, 2.4)
    d.text((total[0] + 14, (drag[1] + total[1]) / 2 + 4), "lift", 14, GOLD, anchor="start")
    d.arrow(center, total, CORAL, 3)
    d.text(((center[0] + total[0]) / 2 + 6, (center[1] + total[1]) / 2 - 12), "*F*", 17, CORAL)

    x = 500
    d.lines((x, 90), ["*u* = flow - (*v_a* + *v_b* + *v_c*) / 3", "*A* *n* = (*x_b* - *x_a*) × (*x_c* - *x_a*) / 2"], 16, 30,
            anchor="start")
    d.text((x, 160), "*n* points to the side by which the water leaves: *n* · *u* ≥ 0", 14, GRAY, anchor="start")
    d.text((x, 205), "*F* = ½ρ*A* ((C_D - C_L)(*u*·*n*) *u* + C_L|*u*|^2 *n*)", 16, CORAL, anchor="start")
    d.text((x, 235), "a third of *F* acts on each of the three masses", 14, GRAY, anchor="start")
    d.text((x, 275), "*F* · *u* ≥ 0: drag never adds energy", 14, TEAL, anchor="start")
    return d


def lattice():
    """One voxel with its springs, and a lattice that shares masses."""
    d = Drawing(860, 350)

    def project(x, y, z, origin, scale):
        return (origin[0] + scale * (x + 0.48 * y), origin[1] - scale * (z + 0.34 * y))

    origin, scale = (70, 275), 150
    corners = list(itertools.product((0, 1), repeat=3))
    styles = {1: (INK, 2.6), 2: (WATER, 1.5), 3: (CORAL, 1.5)}
    for kind in (3, 2, 1):
        for a, b in itertools.combinations(corners, 2):
            if sum(i != j for i, j in zip(a, b)) == kind:
                color, width = styles[kind]
                d.line(project(*a, origin, scale), project(*b, origin, scale), color, width)
    for corner in corners:
        d.mass(project(*corner, origin, scale), 9)
    d.text((155, 312), "one voxel: 8 masses, 28 springs", 15)
    d.line((355, 110), (385, 110), INK, 2.6)
    d.text((395, 115), "12 edges", 14, anchor="start")
    d.line((355, 140), (385, 140), WATER, 1.8)
    d.text((395, 145), "12 face diagonals", 14, anchor="start")
    d.line((355, 170), (385, 170), CORAL, 1.8)
    d.text((395, 175), "4 body diagonals", 14, anchor="start")

    origin, scale = (560, 270), 76
    grid = [(x, y, z) for x in range(4) for y in range(2) for z in range(3)
            if not (z == 2 and x > 2)]
    colors = {(0, 0): "#f4c9b9", (1, 0): "#f7e3bd", (2, 0): "#c9e6e2", (0, 1): "#d9cfe9", (1, 1): "#f4c9b9"}
    for (x, z), fill in colors.items():
        face_corners = [(x, 0, z), (x + 1, 0, z), (x + 1, 0, z + 1), (x, 0, z + 1)]
        d.path([project(*p, origin, scale) for p in face_corners], "none", 0, fill=fill, closed=True)
    for a, b in itertools.combinations(grid, 2):
        if sum(abs(i - j) for i, j in zip(a, b)) == 1 and (2, 1) != (max(a[0], b[0]) - 1, max(a[2], b[2]) - 1):
            d.line(project(*a, origin, scale), project(*b, origin, scale), INK, 1.8)
    for a, b in [((2, 0, 1), (3, 0, 1)), ((2, 1, 1), (3, 1, 1)), ((3, 0, 1), (3, 1, 1)), ((3, 0, 0), (3, 0, 1)),
                 ((3, 1, 0), (3, 1, 1))]:
        d.line(project(*a, origin, scale), project(*b, origin, scale), INK, 1.8)
    for p in grid:
        d.mass(project(*p, origin, scale), 6)
    shared = project(1, 0, 1, origin, scale)
    d.mass(shared, 9, CORAL)
    d.text((680, 312), "neighbors share masses; a spring between two", 14)
    d.text((680, 331), "base materials takes their pair material", 14)
    d.text((origin[0] + 2.52 * scale, origin[1] - 1.72 * scale), "air", 14, GRAY)
    return d


def xpbd():
    """Prediction and projection of one spring."""
    d = Drawing(860, 300)
    a, b = (80, 150), (250, 115)
    pa, pb = (150, 215), (440, 150)
    d.spring(a, b, GRAY, size=6, width=1.4)
    d.mass(a, 8, GRAY)
    d.mass(b, 8, GRAY)
    d.text((70, 130), "*x_a*", color=GRAY)
    d.text((250, 97), "*x_b*", color=GRAY)
    d.arrow((84, 158), (144, 208), WATER, 1.8, "5 4")
    d.arrow((262, 117), (428, 147), WATER, 1.8, "5 4")
    d.text((370, 100), "predict: *p* = *x* + *dt v* + *dt*^2 *F*", 14, WATER)
    d.spring(pa, pb, size=7)
    along = ((pb[0] - pa[0]) / math.dist(pa, pb), (pb[1] - pa[1]) / math.dist(pa, pb))
    d.arrow(pa, (pa[0] + 52 * along[0], pa[1] + 52 * along[1]), TEAL, 3.4)
    d.arrow(pb, (pb[0] - 52 * along[0], pb[1] - 52 * along[1]), TEAL, 3.4)
    d.mass(pa)
    d.mass(pb)
    d.text((140, 245), "*p_a*")
    d.text((455, 175), "*p_b*")
    d.text((205, 258), "+ λ *d* / |*d*|", 14, TEAL)
    d.text((415, 210), "- λ *d* / |*d*|", 14, TEAL)
    x = 530
    d.lines((x, 90), ["*d* = *p_b* - *p_a*,   *C* = |*d*| - *L*"], 16, anchor="start")
    d.text((x, 130), "λ = *C* / (*s_a* + *s_b* + 1 / (*k dt*^2))", 16, TEAL, anchor="start")
    d.lines((x, 170), ["Every spring reads the same prediction *p* (Jacobi)", "and adds its correction to a sum. *s* is the valence",
                       "of a mass, the number of springs at it: each spring",
                       "moves only its share, so that the sum of all", "corrections never overshoots."], 14, 21, color=GRAY, anchor="start")
    return d


def floor():
    """A mass that would end below the floor of the land."""
    d = Drawing(860, 260)
    ground = 150
    d.box((40, ground), (420, 80), PALE, "none", 0, 0)
    d.line((40, ground), (460, ground), INK, 2)
    d.text((70, ground - 10), "*z* = 0", 14)
    start, end = (130, 70), (370, 205)
    d.arrow(start, end, GRAY, 1.8, "5 4")
    d.mass(start, 8)
    d.mass(end, 8, GRAY)
    d.text((130, 52), "*x*")
    d.text((354, 214), "without the floor", 13, GRAY, anchor="end")
    put, held = (370, ground), (328, ground)
    d.arrow(end, (370, ground + 10), WATER, 2.4)
    d.text((380, 182), "depth", 14, WATER, anchor="start")
    d.arrow((362, ground - 14), (336, ground - 14), CORAL, 2.4)
    d.text((352, ground - 24), "≤ friction × depth", 14, CORAL)
    d.mass(held, 8)
    x = 520
    d.lines((x, 70), ["A mass that would end the step below the floor", "ends it on the floor."], 15, 21, anchor="start")
    d.lines((x, 130), ["Its horizontal move becomes shorter by at most", "friction times the depth: Coulomb's law, because",
                       "the depth is *dt*^2 times the normal force."], 15, 21, anchor="start")
    return d


def step():
    """The order of one time step."""
    d = Drawing(860, 190)
    stages = [("environment", ["forces on faces", "and masses"], WATER), ("muscles", ["rest lengths", "at *t = n dt*"], CORAL),
              ("springs", ["force or XPBD,", "integer sums"], TEAL), ("contact", ["floor, friction", "(land)"], GOLD),
              ("velocity", ["from the displace-", "ment, damped"], VIOLET)]
    for i, (name, lines, color) in enumerate(stages):
        x = 25 + i * 167
        d.box((x, 40), (142, 90), "#ffffff", color, 9, 2.2)
        d.text((x + 71, 66), name, 16, color, bold=True)
        d.lines((x + 71, 91), lines, 14)
        if i:
            d.arrow((x - 23, 85), (x - 3, 85), GRAY, 2)
    d.path([(764, 132), (764, 160), (96, 160), (96, 146)], GRAY, 2)
    d.arrow((96, 150), (96, 133), GRAY, 2)
    d.text((430, 178), "next step, many per launch; the masses stay on the chip", 14, GRAY)
    return d


DRAWINGS = {"muscle": muscle, "face": face, "lattice": lattice, "xpbd": xpbd, "floor": floor, "step": step}
