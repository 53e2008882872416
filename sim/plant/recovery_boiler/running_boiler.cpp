#include "sim/plant/recovery_boiler/running_boiler.hpp"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace mpm::sim::boiler {
namespace {

constexpr double kLeastScale = 1e-3;  ///< of states that rest at 0
constexpr double kRest = 1e5;         ///< s, in which everything settles
constexpr double kLevelTime = 100.0;  ///< s, in which feedwater then brings the drum back
constexpr long kMostSteps = 100'000;

void check(int result, const char* what) {
  if (result < 0)
    throw std::runtime_error(std::string("recovery boiler: ") + what + " failed with " +
                             std::to_string(result));
}

}  // namespace

struct RunningBoiler::Solver {
  SUNContext context = nullptr;
  N_Vector vector = nullptr, absolute = nullptr;
  SUNMatrix matrix = nullptr;
  SUNLinearSolver linear = nullptr;
  void* cvode = nullptr;
  Inputs inputs;
  Condition condition;
  bool held_level = false;  ///< feedwater follows the drum, whatever the inputs say

  Solver(States& states, double tolerance) {
    check(SUNContext_Create(nullptr, &context), "SUNContext_Create");
    const auto size = static_cast<sunindextype>(kStates);
    vector = N_VMake_Serial(size, states.data(), context);
    absolute = N_VNew_Serial(size, context);
    for (std::size_t i = 0; i < kStates; ++i)
      N_VGetArrayPointer(absolute)[i] = tolerance * std::max(kLeastScale, std::abs(states[i]));
    matrix = SUNDenseMatrix(size, size, context);
    linear = SUNLinSol_Dense(vector, matrix, context);
    cvode = CVodeCreate(CV_BDF, context);
    check(CVodeInit(cvode, rate, 0.0, vector), "CVodeInit");
    check(CVodeSVtolerances(cvode, tolerance, absolute), "CVodeSVtolerances");
    check(CVodeSetUserData(cvode, this), "CVodeSetUserData");
    check(CVodeSetLinearSolver(cvode, linear, matrix), "CVodeSetLinearSolver");
    check(CVodeSetMaxNumSteps(cvode, kMostSteps), "CVodeSetMaxNumSteps");
  }
  ~Solver() {
    CVodeFree(&cvode);
    SUNLinSolFree(linear);
    SUNMatDestroy(matrix);
    N_VDestroy(absolute);
    N_VDestroy(vector);
    SUNContext_Free(&context);
  }
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;

  static int rate(realtype, N_Vector at, N_Vector result, void* self) {
    const Solver& solver = *static_cast<const Solver*>(self);
    States states;
    std::copy_n(N_VGetArrayPointer(at), kStates, states.begin());
    Inputs inputs = solver.inputs;
    if (solver.held_level)
      inputs.feedwater = moment(states, inputs, solver.condition).streams.drum_flow +
                         (kDrumWater - states[kDrumMass]) / kLevelTime;
    const States change = moment(states, inputs, solver.condition).rates;
    std::copy(change.begin(), change.end(), N_VGetArrayPointer(result));
    return 0;
  }

  /// Inputs jump between two calls: the past tells nothing of what follows.
  void advance(double seconds) {
    check(CVodeReInit(cvode, 0.0, vector), "CVodeReInit");
    check(CVodeSetStopTime(cvode, seconds), "CVodeSetStopTime");
    double reached = 0.0;
    check(CVode(cvode, seconds, vector, &reached, CV_NORMAL), "CVode");
  }
};

RunningBoiler::RunningBoiler(const Inputs& inputs, const Condition& condition, double tolerance)
    : states_(first_guess()) {
  solver_ = std::make_unique<Solver>(states_, tolerance);
  solver_->held_level = true;
  advance(inputs, condition, kRest);
  solver_->held_level = false;
}

RunningBoiler::~RunningBoiler() = default;

void RunningBoiler::advance(const Inputs& inputs, const Condition& condition, double seconds) {
  solver_->inputs = inputs;
  solver_->condition = condition;
  solver_->advance(seconds);
  streams_ = moment(states_, inputs, condition).streams;
}

}  // namespace mpm::sim::boiler
