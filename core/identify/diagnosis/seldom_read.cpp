#include "core/identify/diagnosis/seldom_read.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/identify/fit/free_run.hpp"
#include "core/statistics/historian.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Where a CV of the whole is among those of the part; -1: it is not.
int place_in(const std::vector<int>& cvs, int cv) {
  const auto found = std::lower_bound(cvs.begin(), cvs.end(), cv);
  return found != cvs.end() && *found == cv ? static_cast<int>(found - cvs.begin()) : -1;
}

MatrixXd columns_of(const MatrixXd& all, const std::vector<int>& cvs) {
  if (all.cols() == 0) return all;
  MatrixXd some(all.rows(), static_cast<Index>(cvs.size()));
  for (std::size_t i = 0; i < cvs.size(); ++i) some.col(static_cast<Index>(i)) = all.col(cvs[i]);
  return some;
}

template <class Item>
std::vector<Item> items_of(const std::vector<Item>& all, const std::vector<int>& cvs) {
  std::vector<Item> some;
  for (const Item& item : all) {
    const int cv = place_in(cvs, item.cv);
    if (cv < 0) continue;
    some.push_back(item);
    some.back().cv = cv;
  }
  return some;
}

/// Those of the whole that the part does not have, then the part's.
template <class Item>
std::vector<Item> items_within(const std::vector<Item>& whole, const std::vector<Item>& part,
                               const std::vector<int>& cvs) {
  std::vector<Item> all;
  for (const Item& item : whole)
    if (place_in(cvs, item.cv) < 0) all.push_back(item);
  for (const Item& item : part) {
    all.push_back(item);
    all.back().cv = cvs[static_cast<std::size_t>(item.cv)];
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Item& a, const Item& b) { return a.cv < b.cv; });
  return all;
}

class Lift {
 public:
  /// `aux`: signals that no model uses, set-points not among them.
  Lift(const std::vector<int>& cvs, int aux) : cvs_(cvs), aux_(aux) {}

  void operator()(int& cv) const {
    if (cv >= 0) cv = cvs_[static_cast<std::size_t>(cv)];
  }
  void operator()(Subject& subject) const {
    (*this)(subject.place.cv);
    if (subject.place.aux < aux_) return;
    int of = subject.place.aux - aux_;  // a set-point's CV
    (*this)(of);
    subject.place.aux = aux_ + of;
  }
  void operator()(Finding& finding) const {
    (*this)(finding.subject);
    for (Rival& rival : finding.rivals) (*this)(rival.subject);
    if (finding.with) (*this)(*finding.with);
  }

 private:
  const std::vector<int>& cvs_;
  int aux_;
};

/// Free runs of the whole model, those of the part's CVs as the part has them.
MatrixXd runs_within(const MatrixXd& whole, const MatrixXd& part, const std::vector<int>& cvs) {
  MatrixXd all = whole;
  for (std::size_t i = 0; i < cvs.size(); ++i) all.col(cvs[i]) = part.col(static_cast<Index>(i));
  return all;
}

}  // namespace

std::vector<int> read_at_every_sample(const Recording& recording) {
  std::vector<int> cvs;
  for (Index cv = 0; cv < recording.cvs.cols(); ++cv)
    if (reading_interval(recording.cvs.col(cv)) == 0) cvs.push_back(static_cast<int>(cv));
  return cvs;
}

ModelSpec of_cvs(const ModelSpec& model, const std::vector<int>& cvs) {
  ModelSpec part = model;
  part.cv_count = static_cast<int>(cvs.size());
  part.channels = items_of(model.channels, cvs);
  part.state_terms = items_of(model.state_terms, cvs);
  part.disturbances = items_of(model.disturbances, cvs);
  part.output_blocks.clear();
  part.output_origin.resize(part.cv_count);
  for (std::size_t i = 0; i < cvs.size(); ++i) {
    part.output_blocks.push_back(model.output_blocks[static_cast<std::size_t>(cvs[i])]);
    part.output_origin(static_cast<Index>(i)) = model.output_origin(cvs[i]);
  }
  return part;
}

Recording of_cvs(const Recording& recording, const std::vector<int>& cvs) {
  Recording part = recording;
  part.cvs = columns_of(recording.cvs, cvs);
  part.setpoints = columns_of(recording.setpoints, cvs);
  return part;
}

ModelSpec within(const ModelSpec& whole, const ModelSpec& part, const std::vector<int>& cvs) {
  ModelSpec all = part;
  all.cv_count = whole.cv_count;
  all.channels = items_within(whole.channels, part.channels, cvs);
  all.state_terms = items_within(whole.state_terms, part.state_terms, cvs);
  all.disturbances = items_within(whole.disturbances, part.disturbances, cvs);
  all.output_blocks = whole.output_blocks;
  all.output_origin = whole.output_origin;
  for (std::size_t i = 0; i < cvs.size(); ++i) {
    all.output_blocks[static_cast<std::size_t>(cvs[i])] = part.output_blocks[i];
    all.output_origin(cvs[i]) = part.output_origin(static_cast<Index>(i));
  }
  return all;
}

void to_whole(const ModelSpec& model, const Recording& recording, const Recording* validation,
              const std::vector<int>& cvs, Diagnosis& diagnosis) {
  const Lift lift(cvs, static_cast<int>(recording.aux.cols()));
  for (Finding& finding : diagnosis.findings) lift(finding);
  for (Finding& finding : diagnosis.refused) lift(finding);
  if (diagnosis.suspect) lift(*diagnosis.suspect);
  for (Unexplained& unexplained : diagnosis.unexplained) lift(unexplained.subject);
  for (ChannelEstimate& channel : diagnosis.channels) lift(channel.cv);
  for (Place& place : diagnosis.rejected) lift(place.cv);
  diagnosis.extended = within(model, diagnosis.extended, cvs);
  if (diagnosis.before.rows() == 0) return;  // nothing was judged

  Simulator first(recording);
  const MatrixXd runs = free_runs(first, model);
  diagnosis.before = runs_within(runs, diagnosis.before, cvs);
  diagnosis.after = runs_within(runs, diagnosis.after, cvs);
  MatrixXd unseen_runs = runs;
  if (validation != nullptr) {
    Simulator second(*validation);
    unseen_runs = free_runs(second, model);
    diagnosis.validation_before = runs_within(unseen_runs, diagnosis.validation_before, cvs);
    diagnosis.validation_after = runs_within(unseen_runs, diagnosis.validation_after, cvs);
  }
  const MatrixXd& measured = validation != nullptr ? validation->cvs : recording.cvs;
  const Index rows = diagnosis.validation_samples;
  std::vector<CvScore> scores;
  for (int cv = 0; cv < model.cv_count; ++cv) {
    const int at = place_in(cvs, cv);
    const VectorXd simulated = unseen_runs.col(cv).tail(rows);
    scores.push_back(at >= 0 ? diagnosis.scores[static_cast<std::size_t>(at)]
                             : score(measured.col(cv).tail(rows), simulated, simulated, 1, 0));
    scores.back().judged = at >= 0;
  }
  diagnosis.scores = std::move(scores);
}

}  // namespace mpm
