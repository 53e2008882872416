#!/usr/bin/env python3
"""Draws which channels each method blames: methods.py JSON, as mpm_nonlinear --methods --json writes
it, into methods.svg beside this file. Same numbers, same bytes. Standard library only."""
import json
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
LEFT, TOP, WIDTH = 172, 84, 1000
CELL_W, CELL_H = 26, 18
MAP_W, MAP_H = 3 * CELL_W, 3 * CELL_H
STEP_X, STEP_Y = 103, MAP_H + 24
CVS = MVS = 3
WORDS = {  # what is hidden, for those who do not know the scenarios
    "shell3x3_none": ("nothing hidden",),
    "linear_gain+50_y1u1": ("linear: gain of u1", "on y1 + 50 %"),
    "quadratic_valve": ("u2 bent",),
    "valve_saturation": ("u1 saturates",),
    "sticking_valve": ("u2 sticks",),
    "valve_deadband": ("u2 has play",),
    "gain_and_saturation": ("u1 saturates and", "its gain is wrong"),
    "operating_point_gain": ("u2 on y2: gain", "falls with y2"),
    "output_clipping": ("y1 clips",),
    "square_root_flow": ("u3 on y3: outflow", "by the root"),
    "product_of_inputs": ("u2 times u3",),
    "directional_gain": ("u1 does more one", "way than the other"),
}
# In the dark what is much is light, in the light it is dark: the same colour over the ground.
STYLE = """
 .ground { fill: #ffffff } .ink { fill: #222222 } .grey { fill: #666666 }
 .heat { fill: #1f5fa8 } .cell { fill: none; stroke: #cccccc } .much { fill: #ffffff }
 .mid { fill: #222222 }
 .true { fill: none; stroke: #d9641e; stroke-width: 2 }
 .linear { fill: none; stroke: #d9641e; stroke-width: 2; stroke-dasharray: 3 2 }
 @media (prefers-color-scheme: dark) {
  .ground { fill: #0d1117 } .ink { fill: #e6edf3 } .grey { fill: #9aa4af }
  .heat { fill: #79b8ff } .cell { stroke: #3d444d } .much { fill: #0d1117 }
  .mid { fill: #0d1117 }
  .true, .linear { stroke: #ff9d4d }
 }
"""


def text(x, y, words, kind="ink", size=11, anchor="start", bold=False):
    words = words.replace("&", "&amp;").replace("<", "&lt;")
    more = "" if anchor == "start" else f' text-anchor="{anchor}"'
    more += ' font-weight="bold"' if bold else ""
    return f'<text class="{kind}" x="{x:g}" y="{y:g}" font-size="{size}"{more}>{words}</text>'


def on_heat(share):
    """The class of what is written on that much colour."""
    return "much" if share > 0.75 else "mid" if share > 0.5 else "ink"


def frame(x, y):
    return f"M{x + 1.5:g} {y + 1.5:g}h{CELL_W - 3}v{CELL_H - 3}h{3 - CELL_W}z"


def heat_map(left, top, blamed, case):
    """Rows CVs, columns MVs; the number is per cent."""
    parts = [f'<g transform="translate({left} {top})">']
    frames = {"true": "", "linear": ""}
    for mv in range(MVS):
        for cv in range(CVS):
            channel = mv * CVS + cv
            share = blamed[channel] / case["runs"]
            x, y = mv * CELL_W, cv * CELL_H
            if share > 0:
                parts.append(f'<rect class="heat" x="{x}" y="{y}" width="{CELL_W}" '
                             f'height="{CELL_H}" fill-opacity="{share:.2f}"/>')
                parts.append(text(x + CELL_W / 2, y + 12.5, f"{100 * share:.0f}", on_heat(share), 10,
                                  "middle"))
            for kind, which in (("true", "nonlinear"), ("linear", "linear")):
                if channel in case[which]:
                    frames[kind] += frame(x, y)
    lines = "".join(f"M{x * CELL_W} 0v{MAP_H}" for x in range(MVS + 1))
    lines += "".join(f"M0 {y * CELL_H}h{MAP_W}" for y in range(CVS + 1))
    parts.append(f'<path class="cell" d="{lines}"/>')
    parts += [f'<path class="{kind}" d="{path}"/>' for kind, path in frames.items() if path]
    return parts + ["</g>"]


def legend(y):
    parts = [text(LEFT, y + 12, "blamed in")]
    x = LEFT + 56
    for percent in (0, 25, 50, 75, 100):
        parts.append(f'<rect class="heat" x="{x}" y="{y}" width="{CELL_W + 8}" height="{CELL_H}" '
                     f'fill-opacity="{percent / 100:.2f}"/>')
        parts.append(f'<rect class="cell" x="{x}" y="{y}" width="{CELL_W + 8}" height="{CELL_H}"/>')
        parts.append(text(x + CELL_W / 2 + 4, y + 12.5, f"{percent} %",
                          on_heat(percent / 100), 10, "middle"))
        x += CELL_W + 8
    parts.append(text(x + 8, y + 12, "of the runs"))
    for kind, at, words in (("true", x + 100, "channel that is nonlinear"),
                            ("linear", x + 290, "that is linear, with a wrong gain")):
        parts.append(f'<path class="{kind}" d="{frame(at, y)}"/>')
        parts.append(text(at + CELL_W + 6, y + 12, words))
    return parts


def draw(data):
    cases = data["cases"]
    height = TOP + len(cases) * STEP_Y + 40
    parts = [f'<rect class="ground" width="{WIDTH}" height="{height}"/>',
             text(WIDTH / 2, 24, "Which channels each method blames after 3000 samples", size=15,
                  anchor="middle", bold=True)]
    for m, method in enumerate(data["methods"]):
        parts.append(text(LEFT + m * STEP_X + MAP_W / 2, 54, method, size=12, anchor="middle",
                          bold=True))
        for mv in range(MVS):
            parts.append(text(LEFT + m * STEP_X + (mv + 0.5) * CELL_W, TOP - 8, f"u{mv + 1}",
                              "grey", 10, "middle"))
    for row, case in enumerate(cases):
        top = TOP + row * STEP_Y
        parts.append(text(8, top + 14, case["name"], size=11, bold=True))
        for line, words in enumerate(WORDS.get(case["name"], ())):
            parts.append(text(8, top + 30 + 14 * line, words, "grey"))
        for cv in range(CVS):
            parts.append(text(LEFT - 5, top + 12.5 + cv * CELL_H, f"y{cv + 1}", "grey", 10, "end"))
        for m in range(len(data["methods"])):
            parts += heat_map(LEFT + m * STEP_X, top, case["blamed"][m], case)
    parts += legend(height - 34)
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{height}" '
            f'viewBox="0 0 {WIDTH} {height}" font-family="Helvetica, Arial, sans-serif">\n'
            f"<style>{STYLE}</style>\n" + "\n".join(parts) + "\n</svg>\n")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with open(sys.argv[1], encoding="utf-8") as file:
        data = json.load(file)
    for case in data["cases"]:
        if any(len(blamed) != MVS * CVS for blamed in case["blamed"]):
            sys.exit(f"methods.py: {case['name']} is of no unit of three by three")
    with open(os.path.join(HERE, "methods.svg"), "w", encoding="utf-8", newline="\n") as file:
        file.write(draw(data))


if __name__ == "__main__":
    main()
