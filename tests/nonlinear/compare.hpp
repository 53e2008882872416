#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tests/nonlinear/cases.hpp"
#include "tests/study/run.hpp"

/// The methods of Carlsson 2010, chapter 6, on the same closed loops.
namespace mpm::nonlinear {

enum class Method {
  kConventional,    ///< largest correlation of input and residual over the reported lags
  kLaggedPartial,   ///< likewise (3.15)
  kSpearman,        ///< likewise of the ranks, over every fifth lag from 0 on
  kRankPartial,     ///< likewise, the other inputs' ranks held
  kLinear,          ///< the linear test's verdict
  kPolynomial,      ///< the nonlinear test's verdict
  kKernel,          ///< likewise
  kRandomFeatures,  ///< likewise
};
inline constexpr std::array kMethods = {
    Method::kConventional, Method::kLaggedPartial, Method::kSpearman, Method::kRankPartial,
    Method::kLinear,       Method::kPolynomial,    Method::kKernel,   Method::kRandomFeatures};
/// As the tables and files say it.
inline constexpr std::array kMethodNames = {"correlation",  "(3.15)",         "Spearman",
                                            "rank partial", "linear F test",  "polynomial",
                                            "kernel",       "random features"};
inline constexpr std::size_t kCorrelations = 4;  ///< the first ones have no threshold of their own

/// Samples after which it is asked what a method says.
inline constexpr std::array kAsked = {500, 1000, 1500, 2000, 2500, 3000};

/// What the methods said of one run.
struct Comparison {
  bool diverged = false;
  /// Per method, moment and channel (input * CVs + CV): a magnitude, of a verdict 0 or 1.
  std::array<std::array<std::vector<double>, kAsked.size()>, kMethods.size()> says;
  std::array<double, kMethods.size()> microseconds{};  ///< of computing time per sample
};

[[nodiscard]] Comparison compare(const study::Prepared& prepared, std::uint64_t seed);

struct CompareOptions {
  std::string only = "*";
  std::uint64_t first = 100001;          ///< seed of the runs that are scored
  std::uint64_t first_healthy = 100001;  ///< of the healthy runs that thresholds are taken from
  int runs = 20, healthy_runs = 40, threads = 2;
};

/// How often each method blames each channel at the end of the runs of one case.
struct Blame {
  Case of;
  int runs = 0;  ///< that did not diverge
  /// Per method and channel (input * CVs + CV), in runs.
  std::array<std::vector<int>, kMethods.size()> blamed;
};

struct MethodScores {
  /// As Markdown: of each case that is nonlinear who sees it, from how many samples on, and what of
  /// its linear channels is blamed.
  std::string table;
  std::vector<Blame> blames;
};

/// Of the cases that are nonlinear, a healthy one and one with a linear error. A correlation counts
/// beyond what 1 % of the channels of healthy runs show.
[[nodiscard]] MethodScores compare_methods(const CompareOptions& options);

}  // namespace mpm::nonlinear
