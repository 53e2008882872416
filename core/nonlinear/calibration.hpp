#pragma once

#include <array>
#include <cstdint>

/// The numbers of this room that decide what is said of a channel. Where each comes from: see
/// core/mismatch/calibration.hpp.
namespace mpm::calibration {

/// The columns by which a CV may answer an input as no linear channel does (`NonlinearTerms`).
namespace nonlinear_terms {
/// Standardised values farther out than this count as that far: a cube of what is rarer than one in
/// 16 000 of a normal signal would decide the whole fit. Chosen.
inline constexpr double kFarthest = 4.0;
/// Width of the play whose departure from its input stands for backlash and stiction, s.d. of the
/// input. Chosen: of plays from 0.1 to 0.6 s.d. wide it explains most.
inline constexpr double kPlayWidth = 0.25;
/// Inputs that are multiplied with each other, those that move the CV most. Chosen: six products
/// cost as much as one input's own columns.
inline constexpr int kMostCrossed = 4;
/// This sample's and the one before's, for the noise's own dynamics act on them, too.
inline constexpr int kLags = 2;
/// Samples that the kernels' landmarks are taken from, evenly over all that is remembered.
inline constexpr int kLandmarks = 48;
/// Principal components of a kernel of one input, and of two. Chosen: of a Gaussian kernel of
/// median width, its linear part taken off, four and six hold more than nine tenths.
inline constexpr int kComponents = 4;
inline constexpr int kPairComponents = 6;
/// Frequencies of the random features, each a cosine and a sine, of one input and of two. Chosen:
/// as many columns as the components have, and half as many again, for they are not the best ones.
inline constexpr int kFrequencies = 3;
inline constexpr int kPairFrequencies = 5;
/// They are drawn once and for all.
inline constexpr std::uint64_t kFrequencySeed = 20100601;
}  // namespace nonlinear_terms

/// The linear columns that stand beside the terms (`LinearCompanions`).
namespace linear_companions {
/// No mean is faster than this share of the pulse lags, which show what is. Chosen.
inline constexpr double kFasterThanLags = 0.5;
/// Time constants nearer to each other than this, relative, are one. Derived: they halve.
inline constexpr double kSame = 0.2;
}  // namespace linear_companions

/// When a channel counts as nonlinear.
namespace nonlinear_test {
/// S.d. that a nonlinearity must be worth to be seen: root of the noncentrality at which a
/// chi-square test of 4 degrees of freedom (an input's curve by polynomials, one of the six groups
/// of an input among three) at level 0.01 / 9 / 6 has 94 % power. Derived
/// (tests/core/nonlinear/nonlinear_regression_test.cpp).
inline constexpr double kSeenDeviations = 6.0;
/// Less than this share of the one-step errors' variance does not matter. Chosen: what the linear
/// columns' truncation leaves of errors of 50 % stays below it.
inline constexpr double kMaterialShare = 0.003;
/// Rows per column before anything is said. Chosen: with five p < 0.01 comes in 1.7 % of Shell's
/// healthy channels, with eight in 1.4 %.
inline constexpr double kRowsPerColumn = 8.0;
/// Of what the linear columns explain, what passes for nonlinear because no finite number of them
/// follows a linear error for good; and of what the terms of the inputs to blame explain, what
/// passes for another input's because no few terms follow a bend. Chosen on seeds from 100001 on
/// (tests/nonlinear): time constants that are half the model's leave 0.5 % at most.
inline constexpr double kLeak = 0.01;
inline constexpr double kShareOfBend = 0.25;
/// How much longer it remembers than the linear test's long memory. Chosen: a bend is there for
/// good, and forgetting makes slow columns seem less certain than they are.
inline constexpr double kLongerMemory = 2.5;
/// The terms surely say something where all of them together have a p-value below this. Chosen: one
/// healthy CV in 1000 may be judged with a noise that seems to forget too fast.
inline constexpr double kSurelySomething = 0.001;
/// F is this much too large on healthy loops of Shell after 3000 samples, over all regimes of its
/// disturbances. Fitted on seeds 100101 to 100120 (tests/nonlinear).
inline constexpr double kInflation = 1.06;
}  // namespace nonlinear_test

/// The curve of an input that is told, s.d. of the input to either side and points of it. Chosen.
namespace nonlinear_curve {
inline constexpr double kReach = 2.0;
inline constexpr int kPoints = 21;
}  // namespace nonlinear_curve

/// Ridges that generalised cross-validation chooses among, per mean eigenvalue of the kernel:
/// so many, from the first to the last in equal ratios. Chosen: from as good as none to one that
/// leaves nothing.
namespace ridges {
inline constexpr int kCount = 31;
inline constexpr double kFirst = 1e-6;
inline constexpr double kLast = 1e3;
}  // namespace ridges

/// Rounding. Derived from double precision, with room for some thousand rotations.
namespace nonlinear_rounding {
/// A column of which the ones before it leave less than this share takes no part.
inline constexpr double kOwnShare = 1e-6;
/// Of a rank coefficient's square: what is left of a signal's ranks by others.
inline constexpr double kLeftOfRanks = 1e-12;
/// An eigenvalue below this share of the largest is none.
inline constexpr double kEigenvalue = 1e-10;
}  // namespace nonlinear_rounding

}  // namespace mpm::calibration
