"""Step responses of channels as in model.json, and what inputs do through them."""
import numpy as np


def step_of(channel, time):
    """Step response of a transfer function as in model.json."""
    t = np.maximum(0.0, time - channel["dead_time"])
    poles = list(channel["time_constants"])
    if channel.get("damped_pair"):
        time, damping = channel["damped_pair"]["time"], channel["damped_pair"]["damping"]
        turn = np.sqrt(1 - damping ** 2)
        return channel["gain"] * (1 - np.exp(-damping * t / time) *
                                  (np.cos(turn * t / time) + damping / turn *
                                   np.sin(turn * t / time)))
    if channel.get("integrating"):
        rest = t - sum(T * -np.expm1(-t / T) for T in poles)
        return channel["gain"] * rest
    if not poles:
        return channel["gain"] * (time > channel["dead_time"])
    if len(poles) > 1 and abs(poles[0] / poles[1] - 1) < 1e-6:
        poles[1] *= 1 + 1e-5
    y = np.ones_like(t)
    for i, T in enumerate(poles):
        weight = (T - channel.get("lead", 0.0)) * T ** (len(poles) - 2)
        for j, other in enumerate(poles):
            if j != i:
                weight /= T - other
        y -= weight * np.exp(-t / T)
    return channel["gain"] * np.where(time > channel["dead_time"], y, 0.0)


def answer(channel, moves, sample_time):
    """What an input's moves, sample by sample, do through a channel, from rest."""
    n = len(moves)
    step = step_of(channel, np.arange(n) * sample_time)
    size = 1 << (2 * n - 1).bit_length()
    return np.fft.irfft(np.fft.rfft(step, size) * np.fft.rfft(moves, size), size)[:n]


def settling(channel):
    """Time after which hardly anything of a step is left to come."""
    return channel["dead_time"] + 6 * sum(channel["time_constants"], 0.0)
