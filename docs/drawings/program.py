# SPDX-License-Identifier: Apache-2.0
"""The drawings of docs/architecture.md and docs/performance.md."""

from svg import CORAL, GOLD, GRAY, INK, PALE, TEAL, VIOLET, WATER, Drawing


def chip():
    """A robot in the shared memory of one multiprocessor."""
    d = Drawing(860, 380)
    d.text((120, 34), "device memory", 15, bold=True)
    for i, (label, color) in enumerate([("masses", WATER), ("springs", CORAL), ("faces", GOLD)]):
        y = 55 + 95 * i
        d.box((30, y), (180, 70), "#ffffff", color, 6, 2)
        for k in range(1, 4):
            d.line((30 + 45 * k, y + 6), (30 + 45 * k, y + 44), color, 1)
        for k in range(4):
            d.text((52 + 45 * k, y + 30), f"*r*_{k}", 14)
        d.text((120, y + 62), f"{label}, one chunk per robot", 13, GRAY)
    d.box((290, 45), (540, 300), "#f6f8fa", INK, 10, 1.8)
    d.text((560, 34), "one multiprocessor steps one robot, or several small ones", 15, bold=True)
    d.text((310, 72), "shared memory: masses in tiles of 32", 14, anchor="start")
    rows = ["x", "y", "z", "v_x", "v_y", "v_z", "sum"]
    for tile in range(3):
        x = 330 + 165 * tile
        for r, row in enumerate(rows):
            y = 84 + 17 * r
            if tile == 0:
                d.text((x - 10, y + 12), f"*{row[0]}*" + (f"_{row[2]}" if "_" in row else "") if row != "sum" else "Σ", 12, GRAY)
            for lane in range(12):
                d.box((x + 11.6 * lane, y), (10.4, 14), "#cfe2f1" if row != "sum" else "#f4d9cd", "none", 2, 0)
        d.text((x + 70, 220), f"tile {tile}", 12, GRAY)
    d.text((310, 252), "warps: one row of 32 springs at a time, no two lanes in one bank", 14, anchor="start")
    for warp, color in enumerate((TEAL, CORAL, VIOLET, GOLD)):
        x = 320 + 125 * warp
        d.box((x, 265), (112, 36), "#ffffff", color, 6, 2)
        for lane in range(8):
            d.line((x + 10 + 13 * lane, 272), (x + 10 + 13 * lane, 294), color, 1.6)
    d.text((560, 328), "up to 2,000 steps per launch: masses never leave the chip in between", 13, GRAY)
    d.arrow((214, 90), (286, 130), WATER, 2.4)
    d.arrow((286, 150), (214, 110), WATER, 2.4)
    d.text((250, 165), "once per", 12, GRAY)
    d.text((250, 180), "launch", 12, GRAY)
    d.arrow((214, 190), (316, 278), CORAL, 2)
    d.arrow((214, 280), (316, 286), GOLD, 2)
    d.text((250, 312), "every step", 12, GRAY)
    return d


def journey():
    """The way of a robot from file to picture."""
    d = Drawing(860, 420)

    def node(x, y, title, lines, color, width=180, height=76):
        d.box((x, y), (width, height), "#ffffff", color, 9, 2.2)
        d.text((x + width / 2, y + 26), title, 16, color, bold=True)
        d.lines((x + width / 2, y + 46), lines, 13, 17, color=INK)

    def column(x, title, width=205):
        d.box((x, 14), (width, 392), PALE, "none", 10, 0)
        d.text((x + width / 2, 394), title, 14, GRAY, bold=True)

    column(8, "robots/")
    column(221, "sim/")
    column(434, "app/")
    column(647, "render/")
    node(20, 40, "file", [".json, .cbor", "checked before it is used"], TEAL)
    node(20, 150, "generator", ["voxels, networks, shells", "+ seed"], TEAL)
    node(20, 260, "Robot", ["masses, springs,", "faces, materials"], INK)
    d.arrow((110, 228), (110, 256), GRAY)
    d.path([(20, 78), (14, 78), (14, 298)], GRAY, 2.2)
    d.arrow((14, 298), (18, 298), GRAY)
    node(233, 260, "Simulation", ["a batch: configuration,", "clock, robots"], CORAL)
    node(233, 150, "Backend", ["CPU: vector lanes", "CUDA: on the chip"], CORAL)
    node(233, 40, "physics", ["one source per equation,", "called by both backends"], CORAL)
    d.arrow((202, 298), (229, 298), GRAY)
    d.arrow((308, 258), (308, 230), GRAY)
    d.arrow((338, 230), (338, 258), GRAY)
    d.arrow((323, 148), (323, 120), GRAY)
    node(446, 260, "recording", ["every mass as H5MD,", "played back as a backend"], VIOLET)
    node(446, 150, "position bridge", ["CUDA-GL interop,", "or a copy by the host"], VIOLET)
    node(446, 40, "scene", ["colors, arrows, labels,", "layout, camera"], VIOLET)
    d.arrow((415, 312), (442, 312), GRAY)
    d.arrow((442, 290), (415, 290), GRAY)
    d.arrow((415, 188), (442, 188), GRAY)
    node(659, 150, "renderer", ["buffers and passes;", "knows no simulator"], WATER)
    node(659, 40, "context", ["EGL, OSMesa,", "or a window"], WATER)
    node(659, 260, "picture", ["video by ffmpeg, PNG,", "or the window"], WATER)
    d.arrow((628, 188), (655, 188), GRAY)
    d.arrow((628, 92), (655, 150), GRAY)
    d.arrow((749, 118), (749, 146), GRAY)
    d.arrow((749, 228), (749, 256), GRAY)
    return d


DRAWINGS = {"chip": chip, "journey": journey}
