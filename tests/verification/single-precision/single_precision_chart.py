# SPDX-License-Identifier: Apache-2.0
"""Two panels as SVG: the error of single precision over time, and beside what half the cell changes."""
import math

COLOURS = {"dam break": "#1f77b4", "elastic column": "#2ca02c", "sand column": "#d68910",
           "impact on a wall": "#c0392b"}
WIDTH, HEIGHT, TOP, LEFT, PANEL, GAP = 900, 400, 60, 70, 350, 90
LOW, HIGH = -10, 0  # decades


class Panel:
    """A panel with a logarithmic axis of errors; x runs from 0 to 1."""

    def __init__(self, left, title, x_label):
        self.left, self.parts = left, []
        self.height = HEIGHT - TOP - 60
        self.text(left + PANEL / 2, TOP - 14, title, "middle", 14)
        self.text(left + PANEL / 2, HEIGHT - 18, x_label, "middle")
        for decade in range(LOW, HIGH + 1, 2):
            y = self.y(10.0**decade)
            self.line([(left, y), (left + PANEL, y)], "#dddddd", 1)
            self.text(left - 6, y + 4, f"1e{decade}", "end")
        self.parts.append(f'<rect x="{left}" y="{TOP}" width="{PANEL}" height="{self.height}" '
                          'fill="none" stroke="#444444"/>')

    def x(self, value):
        return self.left + PANEL * value

    def y(self, value):
        decade = min(max(math.log10(max(value, 1e-300)), LOW), HIGH)
        return TOP + self.height * (HIGH - decade) / (HIGH - LOW)

    def text(self, x, y, text, anchor="start", size=12, colour="#222222"):
        self.parts.append(f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" font-size="{size}" '
                          f'fill="{colour}">{text}</text>')

    def line(self, points, colour, width=1.8, dash=""):
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        self.parts.append(f'<polyline points="{path}" fill="none" stroke="{colour}" '
                          f'stroke-width="{width}" stroke-dasharray="{dash}"/>')

    def dot(self, x, y, colour, fill):
        self.parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" stroke="{colour}" fill="{fill}"/>')


def over_time(curves):
    panel = Panel(LEFT, "largest error so far", "time / duration")
    for value in (0, 0.5, 1):
        panel.text(panel.x(value), HEIGHT - 42, f"{value:g}", "middle")
    for index, (problem, curve) in enumerate(curves.items()):
        panel.line([(panel.x(t), panel.y(e)) for t, e in curve], COLOURS[problem])
        panel.text(panel.x(0.03), TOP + 18 + 17 * index, problem, colour=COLOURS[problem])
    return panel.parts


def beside_the_grid(rows):
    """Errors of all figures at all cells: filled; hollow: what half the cell changes."""
    panel = Panel(LEFT + PANEL + GAP, "error of single (filled), change with half the cell (hollow)",
                  "figures; in each, cells from coarse to fine")
    groups = {}
    for row in rows:
        groups.setdefault((row[0], row[1]), []).append(row)
    for index, ((problem, figure), group) in enumerate(groups.items()):
        for place, row in enumerate(group):
            x = panel.x((index + (place + 1) / (len(group) + 1)) / len(groups))
            panel.dot(x, panel.y(row[5]), COLOURS[problem], COLOURS[problem])
            if not math.isnan(row[6]):
                panel.dot(x, panel.y(row[6]), COLOURS[problem], "white")
        x = panel.x((index + 0.5) / len(groups))
        y = HEIGHT - 66
        panel.parts.append(f'<text x="{x:.1f}" y="{y}" font-size="10" fill="#444444" '
                           f'transform="rotate(-90 {x:.1f} {y})">{figure}</text>')
    return panel.parts


def draw(rows, curves):
    return "\n".join([f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" '
                      'font-family="sans-serif">',
                      f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>'] +
                     over_time(curves) + beside_the_grid(rows) + ["</svg>", ""])
