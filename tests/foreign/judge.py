"""Whether a finding of `mpm diagnose` is right: the words are explained in score.py."""
ACCUSES = {"gain", "dead_time", "time_constant", "dynamics", "input_scale", "output_scale",
           "input_nonlinearity", "stiction", "state_nonlinearity", "input_stuck", "input_offset"}
IN_CHANNEL = {"gain": "gain_ratio", "dead_time": "dead_time_error",
              "time_constant": "time_constant_ratio"}
OF_INPUT = {"input_scale", "stiction", "input_stuck", "input_offset"}
SLIGHT_GAIN, SLIGHT_TIME, SLIGHT_DEAD = 0.05, 0.10, 1.0  # ratios; samples


def only_channel(truth, key, tag):
    return sum(channel[key] == tag for channel in truth["channels"]) == 1


def reaches(truth, mv, cv):
    return any(c["cv"] == cv and c["input"] == mv for c in truth["channels"])


def slight(finding, truth):
    numbers = finding.get("parameters", {})
    known = {"gain_ratio": SLIGHT_GAIN, "time_constant_ratio": SLIGHT_TIME}
    if not numbers or not set(numbers) <= {*known, "dead_time_error"}:
        return False
    return all(abs(value) <= SLIGHT_DEAD * truth["sample_time"] if key == "dead_time_error" else
               abs(value - 1.0) <= known[key] for key, value in numbers.items())


def judge(finding, truth):
    """right, place, slight, wrong or else."""
    cause, cv, mv = finding["cause"], finding.get("cv"), finding.get("mv")
    tag = finding.get("tag")
    true, true_cv, true_mv = truth["cause"], truth["cv"], truth["mv"]
    for other in truth["others"] + [truth]:
        if cause == other["cause"] and cause not in ACCUSES:
            if cv == other["cv"] and tag == other["tag"]:
                return "right"
    if cause not in ACCUSES:
        moved = true in ("input_stuck", "input_offset") and cause == "output_disturbance"
        return "place" if moved and reaches(truth, true_mv, cv) else "else"
    # An input's or a CV's only channel is the whole of it.
    if mv is None and cv is not None and only_channel(truth, "cv", cv):
        mv = next(c["input"] for c in truth["channels"] if c["cv"] == cv)
    if cv is None and mv is not None and only_channel(truth, "input", mv):
        cv = next(c["cv"] for c in truth["channels"] if c["input"] == mv)
    if true in IN_CHANNEL:
        if true_cv == cv and true_mv == mv:
            same = cause == true or (cause == "dynamics" and
                                     IN_CHANNEL[true] in finding["parameters"])
            scale = true == "gain" and cause in ("input_scale", "output_scale")
            return "right" if same or scale else "place"
        if cause == "state_nonlinearity" and true_cv == cv and mv is None:
            return "place"
    elif true in OF_INPUT and true_mv == mv:
        deadband = true == "stiction" and finding.get("parameters", {}).get("kind",
                   finding.get("kind")) == "deadband"
        one = true == "input_scale" and cause == "gain" and only_channel(truth, "input", mv)
        return "right" if cause == true or deadband or one else "place"
    elif true == "output_scale" and true_cv == cv:
        return "right" if cause == true else "place"
    return "slight" if slight(finding, truth) else "wrong"


def gains_make_scale(findings, truth):
    """Gains of all channels of an input or a CV are its scale."""
    if truth["cause"] not in ("input_scale", "output_scale"):
        return False
    wanted = {(c["cv"], c["input"]) for c in truth["channels"]
              if (c["input"] == truth["mv"] or c["cv"] == truth["cv"])}
    named = {(f.get("cv"), f.get("mv")) for f in findings if f["cause"] in ("gain", "dynamics")}
    return wanted <= named
