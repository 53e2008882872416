"""The reliability diagram of score.py: how often what is said with a confidence is right, as SVG."""
import math

from judge import ACCUSES
from tables import wilson

EDGES = [0.5, 0.9, 0.99, 0.999, 1.01]
WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 600, 440, 64, 56, 58, 54
TICKS = [0.5, 0.9, 0.99, 0.999]
KINDS = [("what accuses", True, "#1f5fa8", -5), ("everything else", False, "#b3541e", 5)]


def scale(probability):
    """-log10 of what is left, so that 0.9, 0.99 and 0.999 stand apart; from 0.3 to beyond 0.999."""
    left = max(1.0 - probability, 1e-4)
    return (-math.log10(left) + math.log10(0.7)) / (4.0 + math.log10(0.7))


def bins(results, accusing):
    """Mean stated confidence, right, of; of each bin that has any."""
    said = [(f["confidence"], f["is"] == "right") for r in results for f in r.get("findings", [])
            if f["is"] != "slight" and (f["cause"] in ACCUSES) == accusing]
    for low, high in zip(EDGES, EDGES[1:]):
        here = [(c, right) for c, right in said if low <= c < high]
        if here:
            left = sum(1.0 - c for c, _ in here) / len(here)
            yield 1.0 - left, sum(right for _, right in here), len(here)


def diagram(results):
    def x(p):
        return LEFT + scale(p) * (WIDTH - LEFT - RIGHT)

    def y(p):
        return HEIGHT - BOTTOM - scale(p) * (HEIGHT - TOP - BOTTOM)

    svg = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" '
           'font-family="sans-serif" font-size="12">',
           f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>']
    for tick in TICKS:
        svg += [f'<path d="M{x(tick):.1f} {TOP}V{HEIGHT - BOTTOM}M{LEFT} {y(tick):.1f}'
                f'H{WIDTH - RIGHT}" stroke="#ddd"/>',
                f'<text x="{x(tick):.1f}" y="{HEIGHT - BOTTOM + 18}" text-anchor="middle">'
                f'{tick:g}</text>',
                f'<text x="{LEFT - 8}" y="{y(tick) + 4:.1f}" text-anchor="end">{tick:g}</text>']
    svg += [f'<path d="M{x(0.3):.1f} {y(0.3):.1f}L{x(0.9999):.1f} {y(0.9999):.1f}" '
            'stroke="#888" stroke-dasharray="4 3"/>',
            f'<text x="{(LEFT + WIDTH) / 2}" y="{HEIGHT - 12}" text-anchor="middle">'
            'stated confidence</text>',
            f'<text transform="translate(16 {HEIGHT / 2}) rotate(-90)" text-anchor="middle">'
            'share that is right, 95 % interval</text>']
    for number, (name, accusing, colour, aside) in enumerate(KINDS):
        at = LEFT + 8 + 180 * number
        svg += [f'<circle cx="{at}" cy="18" r="4" fill="{colour}"/>',
                f'<text x="{at + 10}" y="22">{name}</text>']
        for stated, right, of in bins(results, accusing):
            low, high = wilson(right, of)
            cx = x(stated) + aside
            svg += [f'<path d="M{cx:.1f} {y(max(low, 0.3)):.1f}V{y(high):.1f}" '
                    f'stroke="{colour}" stroke-width="2"/>',
                    f'<circle cx="{cx:.1f}" cy="{y(max(right / of, 0.3)):.1f}" r="4" '
                    f'fill="{colour}"/>',
                    f'<text x="{cx + (6 if aside > 0 else -6):.1f}" '
                    f'y="{y(max(right / of, 0.3)) - 6:.1f}" fill="{colour}" font-size="11" '
                    f'text-anchor="{"start" if aside > 0 else "end"}">{right}/{of}</text>']
    return "\n".join(svg) + "\n</svg>\n"
