#pragma once

#include <string>

namespace mpm::test {

/// A unit file with everything that an extended model may hold.
inline const std::string kExtendedUnit =
    "unit: t\n"
    "sample_time: 2\n"
    "signals: {mv: [u1, u2], dv: [d1], cv: [y1, y2], aux: [t_amb, p_atm]}\n"
    "operating_point: {u1: 40, y1: 50, y2: 10}\n"
    "model:\n"
    "  channels:\n"
    "    - {cv: y1, mv: u1, tanks: {time_constants: [20, 35], empty_input: 10, empty_output: 20,\n"
    "       overflow: [1.5, .inf], spill: 0.25, dead_time: 3.5}, input: {deadband: 0.5}}\n"
    "    - {cv: y1, mv: u2, gain: 2, time_constants: [9], input: {polynomial: [1, 0.25]}}\n"
    "    - {cv: y2, mv: u1, numerator: [0.1], denominator: [1, -0.9], input: {saturation: [5, "
    "60]}}\n"
    "    - {cv: y2, mv: u2, gain: 3, time_constants: [5], input: {stiction: {band: 2, jump: 1, "
    "slips_once: true}}}\n"
    "    - {cv: y2, dv: d1, step_response: [0, 0.5, 0.75]}\n"
    "  state:\n"
    "    - {cv: y2, mv: u1, restoring_force: {quadratic: 0.125, cubic: -0.5}}\n"
    "    - {cv: y1, mv: u2, square_root_outflow: {empty_output: 5}}\n"
    "    - {cv: y2, dv: d1, coulomb_friction: {force: 0.75, speed: 0.01}}\n"
    "  disturbances:\n"
    "    - {cv: y1, shape: step, onset: 2024-03-01T13:00:00.25+01:00, size: -2, time_constant: "
    "30,\n"
    "       until: 2024-03-02 12:00Z}\n"
    "    - {cv: y2, shape: drift, onset: -100.5, size: 1e-4, until: 1e6}\n"
    "    - {cv: y2, shape: periodic, size: 0.5, period: 70, onset: 7, wave: square}\n"
    "    - {cv: y1, shape: step, onset: 0, size: 1, decay: 600}\n"
    "simulation:\n"
    "  aux_movement: {p_atm: {sigma: 0.2, pole: 0.98}}\n";

}  // namespace mpm::test
