#include "core/regression/leave_one_out_qr.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/archive/archive.hpp"

namespace mpm {
namespace {

constexpr int kBatchRows = 32;

}  // namespace

LeaveOneOutQr::LeaveOneOutQr(int lead_in, int blocks, int block_columns, int responses,
                             double lambda)
    : lead_in_(lead_in),
      block_columns_(block_columns),
      responses_(responses),
      lambda_(lambda),
      rows_(std::max(lead_in + blocks * block_columns + responses, 1), kBatchRows) {
  if (lead_in <= 0 || blocks <= 0 || block_columns <= 0 || responses < 0)
    throw std::invalid_argument("LeaveOneOutQr needs a lead-in and blocks of columns");
  const auto columns = static_cast<std::size_t>(lead_in + blocks * block_columns);
  magnitudes_.assign(columns, 0.0);
  waiting_magnitudes_.assign(columns * kBatchRows, 0.0);
  leaves_.assign(static_cast<std::size_t>(blocks), 0);
  nodes_.reserve(2 * leaves_.size());
  add_node(0, blocks, lead_in, 0);
}

std::size_t LeaveOneOutQr::add_node(int first, int last, int columns, std::size_t depth) {
  const std::size_t index = nodes_.size();
  const int blocks = last - first;
  const int kept = blocks == 1 ? 1 : blocks * block_columns_;
  nodes_.push_back({first, last, GivensQr(columns, kept + responses_)});
  // A child never has more values than its parent; the root's are the longest.
  if (depth == levels_.size())
    levels_.push_back(
        {RowBatch(lead_in_ + static_cast<int>(leaves_.size()) * block_columns_ + responses_,
                  kBatchRows),
         std::vector<double>(kBatchRows)});
  if (blocks == 1) {
    leaves_[static_cast<std::size_t>(first)] = index;
    return index;
  }
  const int middle = first + blocks / 2;
  const std::size_t low = add_node(first, middle, (last - middle) * block_columns_, depth + 1);
  const std::size_t high = add_node(middle, last, (middle - first) * block_columns_, depth + 1);
  nodes_[index].low = low;
  nodes_[index].high = high;
  return index;
}

void LeaveOneOutQr::update() {
  const double* row = rows_.row(waiting_);
  const double root_lambda = std::sqrt(lambda_);
  for (std::size_t c = 0; c < magnitudes_.size(); ++c)
    magnitudes_[c] = std::max(magnitudes_[c] * root_lambda, std::abs(row[c]));
  std::copy(
      magnitudes_.begin(), magnitudes_.end(),
      waiting_magnitudes_.begin() + static_cast<std::ptrdiff_t>(magnitudes_.size()) * waiting_);
  if (++waiting_ == kBatchRows) fold();
}

void LeaveOneOutQr::fold() {
  if (waiting_ == 0) return;
  Level& level = levels_.front();
  Node& root = nodes_.front();
  const int blocks = static_cast<int>(leaves_.size());
  const int kept = lead_in_ + (blocks == 1 ? 1 : blocks * block_columns_);
  for (int k = 0; k < waiting_; ++k) {
    const double* row = rows_.row(k);
    double* out = std::copy_n(row, kept, level.rows.row(k));
    std::copy_n(row + magnitudes_.size(), responses_, out);
    level.weights[static_cast<std::size_t>(k)] = 1.0;
  }
  take(root, 0, waiting_magnitudes_.data());
  waiting_ = 0;
}

void LeaveOneOutQr::Node::archive(Archive& a) {
  // not archived: first, last, low, high (construction)
  a(factor);
}

void LeaveOneOutQr::archive(Archive& a) {
  // not archived: lead_in_, block_columns_, responses_, lambda_, leaves_ (construction)
  // not archived: levels_ (empty between calls)
  a.within(waiting_, 0, kBatchRows - 1);
  a(magnitudes_);
  a.doubles(waiting_magnitudes_.data(), magnitudes_.size() * static_cast<std::size_t>(waiting_));
  for (int k = 0; k < waiting_; ++k)
    a.doubles(rows_.row(k), magnitudes_.size() + static_cast<std::size_t>(responses_));
  a(nodes_);
}

void LeaveOneOutQr::take(Node& node, std::size_t depth, const double* magnitudes) {
  Level& level = levels_[depth];
  node.factor.rotate_batch(level.rows, waiting_, lambda_, level.weights.data(), magnitudes,
                           magnitudes_.size());
  if (node.last - node.first == 1) {
    node.factor.accumulate_batch(level.rows, waiting_, lambda_, level.weights.data());
    return;
  }
  Node& low = nodes_[node.low];
  Node& high = nodes_[node.high];
  hand_down(node, low, high.first, high.last, depth);
  hand_down(node, high, low.first, low.last, depth);
}

// The child eliminates the blocks out_first..out_last-1 of what the parent left.
void LeaveOneOutQr::hand_down(const Node& parent, Node& child, int out_first, int out_last,
                              std::size_t depth) {
  const Level& from = levels_[depth];
  Level& to = levels_[depth + 1];
  const int kept = child.last - child.first;
  for (int k = 0; k < waiting_; ++k) {
    const double* left = parent.factor.left(from.rows, k);
    const auto columns_at = [&](int block) {
      return left + (block - parent.first) * block_columns_;
    };
    double* out = to.rows.row(k);
    out = std::copy_n(columns_at(out_first), (out_last - out_first) * block_columns_, out);
    out = std::copy_n(columns_at(child.first), kept == 1 ? 1 : kept * block_columns_, out);
    std::copy_n(columns_at(parent.last), responses_, out);
    to.weights[static_cast<std::size_t>(k)] = from.weights[static_cast<std::size_t>(k)];
  }
  take(child, depth + 1, waiting_magnitudes_.data() + lead_in_ + out_first * block_columns_);
}

}  // namespace mpm
