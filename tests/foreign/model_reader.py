"""Step responses of the model in a unit file that `mpm` has written: one channel or block a line.

Transfer functions, discrete filters and step responses; of the blocks at inputs and outputs what
they do to the gain: the slope of a block's output on its input over the recording.
"""
import re

import numpy as np

from channels import Channel, step_response


def parse_flow(text):
    """{a: 1, b: [2, 3]} and what stands in it; scalars as numbers, booleans or text."""
    tokens = re.findall(r'"(?:[^"\\]|\\.)*"|[{}\[\],]|:(?=\s|$)|[^{}\[\],:\s]+', text)
    at = 0

    def value():
        nonlocal at
        token = tokens[at]
        at += 1
        if token == "{":
            result = {}
            while tokens[at] != "}":
                key = tokens[at]
                at += 2  # and its colon
                result[key] = value()
                at += tokens[at] == ","
            at += 1
            return result
        if token == "[":
            result = []
            while tokens[at] != "]":
                result.append(value())
                at += tokens[at] == ","
            at += 1
            return result
        try:
            return float(token)
        except ValueError:
            return {"true": True, "false": False}.get(token, token.strip('"'))

    return value()


def read_model(text):
    """Channels, blocks of inputs and of outputs by tag, operating point."""
    channels, blocks, section, inside = [], {"input": {}, "output": {}}, "", False
    origin = {}
    for line in text.splitlines():
        if re.match(r"\S", line) and not line.startswith("#"):
            inside = line.startswith("model:")
            continue
        bare = re.sub(r"\s+#.*$", "", line)
        if not inside or not bare.strip() or bare.lstrip().startswith("#"):
            continue
        head = re.match(r"  (\w+):\s*(.*)$", bare)
        if head:
            section = head.group(1)
            if section == "operating_point":
                origin = parse_flow(head.group(2))
        elif section == "channels":
            channels.append(parse_flow(bare.strip()[2:]))
        elif section in blocks:
            tag, block = re.match(r"\s+([^:]+): (.*)$", bare).groups()
            blocks[section][tag.strip('"')] = parse_flow(block)
    return channels, blocks["input"], blocks["output"], origin


def channel_step(item, sample_time, samples):
    if "step_response" in item:
        values = np.array(item["step_response"])
        return np.concatenate([values, np.full(samples, values[-1])])[:samples]
    if "numerator" in item:
        b, a = np.array(item["numerator"]), np.array(item.get("denominator", [1.0]))
        delay = int(item.get("delay_samples", 0)) + 1
        y = np.zeros(samples)
        for k in range(samples):
            y[k] = b[:max(0, k - delay + 1)].sum()
            y[k] -= sum(a[i] * y[k - i] for i in range(1, min(len(a), k + 1)))
            y[k] /= a[0]
        return y
    lags = tuple(t / sample_time for t in item.get("time_constants", []))
    dead, lead = item.get("dead_time", 0.0) / sample_time, item.get("lead", 0.0) / sample_time
    ramps = bool(item.get("integrating", False))
    gain = item["gain"] * (sample_time if ramps else 1.0)
    if not lags and not ramps:
        return gain * (np.arange(samples) >= dead + 1)
    return step_response(Channel(0, 0, gain, lags, dead, lead, ramps), samples)


def play(values, band, jump):
    """A valve of this band and jump; a deadband jumps by nothing."""
    result, position = np.zeros(len(values)), values[0]
    moving = 0.0
    for k, value in enumerate(values):
        way = np.sign(value - values[k - 1]) if k else 0.0
        moving = moving if way == moving else 0.0
        if moving or abs(value - position) > (band + jump) / 2:
            moving = np.sign(value - position)
            position = value - moving * (band - jump) / 2
        result[k] = position
    return result


def slope(block, values):
    """Of the block's output on its input; values in their own units, from the operating point."""
    if values.std() < 1e-12:
        return 1.0
    if "polynomial" in block:
        out = sum(c * values**(i + 1) for i, c in enumerate(block["polynomial"]))
    elif "deadband" in block:
        out = play(values, block["deadband"], 0.0)
    elif "stiction" in block:
        out = play(values, block["stiction"]["band"], block["stiction"]["jump"])
    else:
        return 1.0
    return float(np.cov(out, values)[0, 1] / values.var(ddof=1))


def model_steps(text, sample_time, samples, inputs):
    """(cv, input) -> step response of the unit file's model. `inputs`: tag -> recorded values."""
    channels, of_input, of_output, origin = read_model(text)
    steps = {}
    for item in channels:
        tag = item.get("mv", item.get("dv", item.get("input")))
        ratio = 1.0
        blocks = [of_input.get(tag)] + [item["input"] if isinstance(item.get("input"), dict) else
                                        None]
        for block in blocks:
            if block is not None and tag in inputs:
                ratio *= slope(block, inputs[tag] - origin.get(tag, 0.0))
        ratio *= of_output.get(item["cv"], {}).get("scale", 1.0)
        steps[item["cv"], tag] = ratio * channel_step(item, sample_time, samples)
    return steps
