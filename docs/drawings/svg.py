# SPDX-License-Identifier: Apache-2.0
"""A small canvas for the drawings of docs/: lines, arrows, springs, masses and labels as SVG."""

import math

INK, GRAY, PALE = "#22313f", "#8795a1", "#e9eef2"
WATER, CORAL, GOLD, TEAL, VIOLET = "#2b7fb9", "#d9532c", "#d9962b", "#14897e", "#7457a6"
FONT = "Lato, 'Helvetica Neue', Helvetica, Arial, sans-serif"


class Drawing:
    """A drawing `width` x `height` units wide, y down. Coordinates are (x, y) pairs."""

    def __init__(self, width, height):
        self.width, self.height = width, height
        self.parts = []
        self.arrowheads = {}

    def add(self, text):
        self.parts.append(text)

    def line(self, a, b, color=INK, width=1.6, dash="", arrow=False):
        head = f' marker-end="url(#{self.head(color)})"' if arrow else ""
        dashes = f' stroke-dasharray="{dash}"' if dash else ""
        self.add(f'<line x1="{a[0]:.1f}" y1="{a[1]:.1f}" x2="{b[0]:.1f}" y2="{b[1]:.1f}" stroke="{color}" '
                 f'stroke-width="{width}" stroke-linecap="round"{dashes}{head}/>')

    def arrow(self, a, b, color=INK, width=2.2, dash=""):
        self.line(a, b, color, width, dash, arrow=True)

    def dimension(self, a, b, text, offset=0, color=GRAY):
        """A double-headed arrow from a to b, its text beside the middle."""
        middle = ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)
        self.arrow(middle, a, color, 1.3)
        self.arrow(middle, b, color, 1.3)
        self.text((middle[0], middle[1] + offset), text, color=INK)

    def path(self, points, color=INK, width=1.6, fill="none", closed=False, dash=""):
        text = "M" + " L".join(f"{x:.1f},{y:.1f}" for x, y in points) + (" Z" if closed else "")
        dashes = f' stroke-dasharray="{dash}"' if dash else ""
        self.add(f'<path d="{text}" fill="{fill}" stroke="{color}" stroke-width="{width}" '
                 f'stroke-linejoin="round" stroke-linecap="round"{dashes}/>')

    def spring(self, a, b, color=CORAL, coils=7, size=8, width=2.2):
        """A zigzag from a to b with straight ends."""
        length = math.dist(a, b)
        along = ((b[0] - a[0]) / length, (b[1] - a[1]) / length)
        across = (-along[1], along[0])
        points = [a]
        for i in range(2 * coils + 1):
            share = 0.16 + 0.68 * i / (2 * coils)
            side = 0 if i in (0, 2 * coils) else size * (1 if i % 2 else -1)
            points.append((a[0] + share * length * along[0] + side * across[0],
                           a[1] + share * length * along[1] + side * across[1]))
        self.path([*points, b], color, width)

    def mass(self, at, radius=9, color=INK, ring=None):
        self.add(f'<circle cx="{at[0]:.1f}" cy="{at[1]:.1f}" r="{radius}" fill="{color}" '
                 f'stroke="{ring or "#ffffff"}" stroke-width="1.6"/>')

    def box(self, corner, size, fill="#ffffff", color=INK, radius=7, width=1.4, dash=""):
        dashes = f' stroke-dasharray="{dash}"' if dash else ""
        self.add(f'<rect x="{corner[0]:.1f}" y="{corner[1]:.1f}" width="{size[0]:.1f}" height="{size[1]:.1f}" '
                 f'rx="{radius}" fill="{fill}" stroke="{color}" stroke-width="{width}"{dashes}/>')

    def text(self, at, text, size=15, color=INK, anchor="middle", bold=False, italic=False):
        """Text with its baseline at `at`. `_x` makes x a subscript, `^x` a superscript, `*x*` italic."""
        weight = ' font-weight="600"' if bold else ""
        slant = ' font-style="italic"' if italic else ""
        self.add(f'<text x="{at[0]:.1f}" y="{at[1]:.1f}" font-size="{size}" fill="{color}" '
                 f'text-anchor="{anchor}"{weight}{slant}>{marked_up(text, size)}</text>')

    def lines(self, at, lines, size=14, step=19, **style):
        for i, text in enumerate(lines):
            self.text((at[0], at[1] + i * step), text, size, **style)

    def head(self, color):
        return self.arrowheads.setdefault(color, f"head{len(self.arrowheads)}")

    def document(self):
        heads = "".join(
            f'<marker id="{name}" viewBox="0 0 10 10" refX="8.5" refY="5" markerWidth="6.5" markerHeight="6.5" '
            f'orient="auto-start-reverse"><path d="M0,1 L9,5 L0,9 Z" fill="{color}"/></marker>'
            for color, name in self.arrowheads.items())
        body = "\n".join(self.parts)
        return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {self.width} {self.height}" '
                f'width="{self.width}" height="{self.height}" font-family="{FONT}">\n<defs>{heads}</defs>\n'
                f'<rect width="{self.width}" height="{self.height}" rx="10" fill="#ffffff"/>\n{body}\n</svg>\n')


def marked_up(text, size):
    """The text with its subscripts, superscripts and italics as tspan elements."""
    result, i, italic = "", 0, False
    text = text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
    while i < len(text):
        if text[i] in "_^" and i + 1 < len(text):
            end = text.index("}", i) if text[i + 1] == "{" else i + 1
            inner = text[i + 2:end] if text[i + 1] == "{" else text[i + 1]
            shift = (0.28 if text[i] == "_" else -0.38) * size
            result += (f'<tspan dy="{shift:.1f}" font-size="{0.72 * size:.1f}">{inner}</tspan>'
                       f'<tspan dy="{-shift:.1f}">&#8203;</tspan>')
            i = end + 1
        elif text[i] == "*":
            italic = not italic
            result += '<tspan font-style="italic">' if italic else "</tspan>"
            i += 1
        else:
            result += text[i]
            i += 1
    return result
