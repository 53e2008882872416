#!/usr/bin/env python3
"""Draws what figures 4.1 to 4.9 of Carlsson 2010 show, from our own runs: ./run figures

Same programs, same seed, same bytes. Standard library only. The thesis draws one run of each
scenario; so does this, seed 1 of each.
"""
import os
import tempfile

import runs

SEED = 1
HERE = os.path.dirname(os.path.abspath(__file__))
INK, GREY, FAINT = "#222222", "#888888", "#dddddd"
BLUE, ORANGE, TINT = "#1f5fa8", "#d9641e", "#fdf0d5"


class Picture:
    def __init__(self, width, height, title):
        self.width, self.height, self.parts = width, height, []
        self.rect(0, 0, width, height, "#ffffff")
        self.text(width / 2, 22, title, size=15, anchor="middle", bold=True)

    def rect(self, x, y, width, height, fill, stroke=None):
        line = f' stroke="{stroke}"' if stroke else ""
        self.parts.append(f'<rect x="{x:.1f}" y="{y:.1f}" width="{width:.1f}" '
                          f'height="{height:.1f}" fill="{fill}"{line}/>')

    def line(self, x1, y1, x2, y2, colour, width=1.0, dash=None):
        dashes = f' stroke-dasharray="{dash}"' if dash else ""
        self.parts.append(f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" '
                          f'stroke="{colour}" stroke-width="{width}"{dashes}/>')

    def path(self, data, colour, width):
        self.parts.append(f'<path d="{data}" fill="none" stroke="{colour}" '
                          f'stroke-width="{width}" stroke-linejoin="round"/>')

    def curve(self, points, colour, width=1.2):
        self.path("M" + " ".join(f"{x:.1f},{y:.1f}" for x, y in points), colour, width)

    def text(self, x, y, text, size=11, anchor="start", colour=INK, bold=False, turned=False):
        text = text.replace("&", "&amp;").replace("<", "&lt;")
        weight = ' font-weight="bold"' if bold else ""
        turn = f' transform="rotate(-90 {x:.1f} {y:.1f})"' if turned else ""
        self.parts.append(f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" '
                          f'text-anchor="{anchor}" fill="{colour}"{weight}{turn}>{text}</text>')

    def write(self, name):
        with open(os.path.join(HERE, name + ".svg"), "w", newline="\n") as file:
            file.write(f'<svg xmlns="http://www.w3.org/2000/svg" width="{self.width}" '
                       f'height="{self.height}" viewBox="0 0 {self.width} {self.height}" '
                       'font-family="Helvetica, Arial, sans-serif">\n')
            file.write("\n".join(self.parts) + "\n</svg>\n")
        print(name + ".svg")


def step_points(values, x_at, y_at):
    """Corners of a signal that is held between changes."""
    points = [(x_at(0), y_at(values[0]))]
    for k in range(1, len(values)):
        if values[k] != values[k - 1]:
            points += [(x_at(k), y_at(values[k - 1])), (x_at(k), y_at(values[k]))]
    return points + [(x_at(len(values) - 1), y_at(values[-1]))]


def draw_responses(name, title, columns, benchmark):
    """Figures 4.1, 4.3, 4.5, 4.7: set-points and controlled variables."""
    left, width, height, gap = 62, 900, 150, 44
    picture = Picture(left + width + 20, 58 + 3 * (height + gap) + 24, title)
    for cv in range(3):
        sp, y = columns[f"sp{cv + 1}"], columns[f"y{cv + 1}"]
        top = 58 + cv * (height + gap)
        limit = max(1.0, max(map(abs, y)) * 1.05)
        samples = len(y)
        x_at = lambda k: left + width * k / samples  # noqa: E731
        y_at = lambda v: top + height * (0.5 - v / (2 * limit))  # noqa: E731
        picture.rect(left, top, width, height, "#ffffff", GREY)
        for v in (-1, 0, 1):
            picture.line(left, y_at(v), left + width, y_at(v), FAINT)
            picture.text(left - 6, y_at(v) + 4, str(v).replace("-", "\u2212"), anchor="end")
        for k in range(0, samples + 1, 500):
            picture.line(x_at(k), top + height, x_at(k), top + height + 4, GREY)
            picture.text(x_at(k), top + height + 16, str(k), anchor="middle", size=10)
        # Every other sample: looks the same at this width and takes half the bytes.
        picture.curve([(x_at(k), y_at(y[k])) for k in range(0, samples, 2)], BLUE)
        picture.curve(step_points(sp, x_at, y_at), ORANGE, 1.4)
        variance = f"variance of the control error {runs.control_error_variance(columns, cv):.4f}"
        if benchmark is not None:
            variance += f" (scenario 1: {runs.control_error_variance(benchmark, cv):.4f})"
        picture.text(left, top - 6, f"CV{cv + 1}", bold=True)
        picture.text(left + 36, top - 6, variance)
        picture.text(20, top + height / 2, f"CV{cv + 1}", anchor="middle", turned=True)
    legend = 58 - 6
    picture.line(left + width - 190, legend - 4, left + width - 165, legend - 4, ORANGE, 1.6)
    picture.text(left + width - 160, legend, "set-point")
    picture.line(left + width - 95, legend - 4, left + width - 70, legend - 4, BLUE, 1.6)
    picture.text(left + width - 65, legend, "measured")
    picture.text(left + width / 2, picture.height - 10, "sample", anchor="middle")
    picture.write(name)


PANEL_W, PANEL_H, PANEL_GAP = 132, 76, 8
BLOCK_W = 3 * (PANEL_W + PANEL_GAP)
BLOCK_H = 3 * (PANEL_H + PANEL_GAP)


def draw_block(picture, left, top, title, correlations, true_channels):
    """3 x 3 panels, rows CVs, columns MVs: correlation over lag, and the mean line."""
    picture.text(left, top - 24, title, size=13, bold=True)
    picture.text(left + BLOCK_W - PANEL_GAP, top - 24, f"mean line {correlations.line:.3f}",
                 anchor="end", colour=ORANGE)
    for mv in range(3):
        picture.text(left + mv * (PANEL_W + PANEL_GAP) + PANEL_W / 2, top - 7, f"MV{mv + 1}",
                     anchor="middle")
    for cv in range(3):
        for mv in range(3):
            draw_panel(picture, left + mv * (PANEL_W + PANEL_GAP), top + cv * (PANEL_H + PANEL_GAP),
                       cv, mv, correlations, (cv, mv) in true_channels)
        picture.text(left - 32, top + cv * (PANEL_H + PANEL_GAP) + PANEL_H / 2, f"CV{cv + 1}",
                     anchor="middle", turned=True)
    picture.text(left + BLOCK_W / 2, top + BLOCK_H + 18, "lag d in samples", anchor="middle",
                 size=10)


def draw_panel(picture, left, top, cv, mv, correlations, is_true):
    values = correlations.values[(cv, mv)]
    first = runs.FIRST_LAG
    last = first + len(values) - 1
    x_at = lambda d: left + PANEL_W * (d - first + 1) / (last - first + 2)  # noqa: E731
    y_at = lambda c: top + PANEL_H * (1 - c) / 2  # noqa: E731
    picture.rect(left, top, PANEL_W, PANEL_H, TINT if is_true else "#ffffff", GREY)
    picture.line(x_at(0), top, x_at(0), top + PANEL_H, FAINT)
    picture.line(left, y_at(0), left + PANEL_W, y_at(0), GREY, 0.8)
    stems = "".join(f"M{x_at(first + l):.1f},{y_at(0):.1f}V{y_at(c):.1f}"
                    for l, c in enumerate(values))
    picture.path(stems, BLUE, 2.4)
    for sign in (1, -1):
        height = y_at(sign * correlations.line)
        picture.line(left, height, left + PANEL_W, height, ORANGE, 1.1, "4 2")
    largest = correlations.largest[(cv, mv)]
    at_foot = largest > 0.6 and sum(values[-15:]) > 0  # or it would stand on the bars
    picture.text(left + PANEL_W - 4, top + (PANEL_H - 5 if at_foot else 11), f"{largest:.2f}", size=10, anchor="end",
                 bold=largest > correlations.line)
    if mv == 0:
        for c in (-1, 0, 1):
            shift = {1: 8, 0: 4, -1: 0}[c]
            picture.text(left - 5, y_at(c) + shift, str(c).replace("-", "\u2212"), size=9,
                         anchor="end")
    if cv == 2:
        for d in range(first, last + 1, 10):
            anchor = "start" if d == first else "end" if d == last else "middle"
            x = left if d == first else left + PANEL_W if d == last else x_at(d)
            picture.text(x, top + PANEL_H + 11, str(d).replace("-", "\u2212"), size=9,
                         anchor=anchor)


NOTE = ("Correlation, \u22121 to 1, over lag. Orange: mean line. Number: largest |correlation| at lags \u2265 1, bold above the line. "
        "Tinted: channels that the thesis wants found.")
LEFT, TOP, COLUMN, ROW = 56, 92, BLOCK_W + 68, BLOCK_H + 84


def draw_correlations(name, title, blocks, true_channels):
    """Figures 4.2, 4.4, 4.6, 4.8: one block per method; the thesis has the first three."""
    picture = Picture(2 * COLUMN + 8, TOP + 2 * ROW - 36, title)
    picture.text(picture.width / 2, 42, NOTE, anchor="middle", colour=GREY)
    for b, (block_title, correlations) in enumerate(blocks):
        draw_block(picture, LEFT + (b % 2) * COLUMN, TOP + (b // 2) * ROW, block_title,
                   correlations, true_channels)
    picture.write(name)


def draw_sweep(name, title, blocks, true_channels):
    """Figure 4.9: one block per g, and the largest correlations over g."""
    picture = Picture(3 * COLUMN + 8, TOP + 2 * ROW - 36, title)
    picture.text(picture.width / 2, 42, NOTE, anchor="middle", colour=GREY)
    for b, (g, correlations) in enumerate(blocks):
        draw_block(picture, LEFT + (b % 3) * COLUMN, TOP + (b // 3) * ROW,
                   f"g = {g} previous inputs", correlations, true_channels)
    left, top = LEFT + 2 * COLUMN, TOP + ROW
    width, height = BLOCK_W - PANEL_GAP, BLOCK_H - PANEL_GAP
    picture.text(left, top - 24, "largest |correlation| at lags \u2265 1", size=13, bold=True)
    picture.text(left, top - 8, "black: channels to be found; blue: the others; orange: mean line",
                 colour=GREY, size=10)
    picture.rect(left, top, width, height, "#ffffff", GREY)
    x_at = lambda b: left + width * (b + 0.5) / len(blocks)  # noqa: E731
    y_at = lambda c: top + height * (1 - c)  # noqa: E731
    for c in (0.0, 0.25, 0.5, 0.75, 1.0):
        picture.line(left, y_at(c), left + width, y_at(c), FAINT)
        picture.text(left - 5, y_at(c) + 4, f"{c:g}", size=9, anchor="end")
    for b, (g, _) in enumerate(blocks):
        picture.text(x_at(b), top + height + 11, str(g), size=9, anchor="middle")
    picture.text(left + BLOCK_W / 2, top + BLOCK_H + 18, "g", anchor="middle", size=10)
    channels = [(cv, mv) for cv in range(3) for mv in range(3)]
    for channel in sorted(channels, key=lambda c: c in true_channels):
        found = channel in true_channels
        picture.curve([(x_at(b), y_at(c.largest[channel])) for b, (_, c) in enumerate(blocks)],
                      INK if found else BLUE, 2.2 if found else 1.0)
    picture.curve([(x_at(b), y_at(c.line)) for b, (_, c) in enumerate(blocks)], ORANGE, 1.6)
    picture.write(name)


FIGURES = {  # scenario -> numbers of the thesis's figures: responses, correlations
    "none": ("4_1", "4_2"),
    "s2_gain25_no_integral": ("4_3", "4_4"),
    "s2_gain25_limits": ("4_3", "4_4"),
    "s2_gain25": ("4_3", "4_4"),
    "s2_gain15": ("4_3", "4_4"),
    "s3_delay": ("4_5", "4_6"),
    "s4_gain40": ("4_7", "4_8"),
}
SHORT = {"none": "s1", "s2_gain25": "s2_high_model"}


def main():
    with tempfile.TemporaryDirectory() as folder:
        benchmark = None
        for _, title, plant, scenario, true_channels in runs.STUDIES:
            path = runs.simulate(plant, scenario, SEED, folder)
            columns = runs.read(path)
            responses, panels = FIGURES[scenario]
            short = SHORT.get(scenario, scenario)
            draw_responses(f"{responses}_{short}_responses", title, columns, benchmark)
            benchmark = benchmark or columns
            blocks = [(f"({letter}) {method.replace('_', ' ')} ({equation})",
                       runs.Correlations(plant, path, method))
                      for letter, (method, equation) in zip("abcd", runs.METHODS)]
            draw_correlations(f"{panels}_{short}_correlations", title, blocks, true_channels)
        for name, base in (("s4", runs.STUDIES[-1]), ("s3", runs.STUDIES[-2])):
            blocks = [(g, runs.Correlations(base[2], runs.simulate(base[2], f"{name}_g{g}", SEED,
                                                                   folder), "lagged_partial", g))
                      for g in runs.LAGS_SWEPT]
            draw_sweep(f"4_9_{name}_g_sweep", base[1] + "; lagged partial correlation (3.15) by g",
                       blocks, base[4])


if __name__ == "__main__":
    main()
