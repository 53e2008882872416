#include "core/regression/leave_one_out_qr.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace mpm {

LeaveOneOutQr::LeaveOneOutQr(int lead_in, int blocks, int block_columns, int responses)
    : lead_in_(lead_in), block_columns_(block_columns), responses_(responses) {
  if (lead_in <= 0 || blocks <= 0 || block_columns <= 0 || responses < 0)
    throw std::invalid_argument("LeaveOneOutQr needs a lead-in and blocks of columns");
  const auto columns = static_cast<std::size_t>(lead_in + blocks * block_columns);
  row_.assign(columns + static_cast<std::size_t>(responses), 0.0);
  magnitudes_.assign(columns, 0.0);
  leaves_.assign(static_cast<std::size_t>(blocks), 0);
  nodes_.reserve(2 * leaves_.size());
  add_node(0, blocks, lead_in);
}

std::size_t LeaveOneOutQr::add_node(int first, int last, int columns) {
  const std::size_t index = nodes_.size();
  const int blocks = last - first;
  const int kept = blocks == 1 ? 1 : blocks * block_columns_;
  nodes_.push_back({first, last, GivensQr(columns, kept + responses_)});
  if (blocks == 1) {
    leaves_[static_cast<std::size_t>(first)] = index;
    return index;
  }
  const int middle = first + blocks / 2;
  const std::size_t low = add_node(first, middle, (last - middle) * block_columns_);
  const std::size_t high = add_node(middle, last, (middle - first) * block_columns_);
  nodes_[index].low = low;
  nodes_[index].high = high;
  return index;
}

void LeaveOneOutQr::update(double lambda) {
  const double root_lambda = std::sqrt(lambda);
  for (std::size_t c = 0; c < magnitudes_.size(); ++c)
    magnitudes_[c] = std::max(magnitudes_[c] * root_lambda, std::abs(row_[c]));
  Node& root = nodes_.front();
  const int blocks = static_cast<int>(leaves_.size());
  const double* responses = row_.data() + magnitudes_.size();
  double* out = std::copy_n(row_.data(), lead_in_ + (blocks == 1 ? 1 : blocks * block_columns_),
                            root.factor.row());
  std::copy_n(responses, responses_, out);
  take(root, lambda, 1.0, magnitudes_.data());
}

void LeaveOneOutQr::take(Node& node, double lambda, double weight, const double* magnitudes) {
  const double left_weight = node.factor.rotate(lambda, weight, magnitudes);
  if (node.last - node.first == 1) {
    node.factor.accumulate(lambda, left_weight);
    return;
  }
  Node& low = nodes_[node.low];
  Node& high = nodes_[node.high];
  hand_down(node, low, high.first, high.last, lambda, left_weight);
  hand_down(node, high, low.first, low.last, lambda, left_weight);
}

// The child eliminates the blocks out_first..out_last-1 of what the parent left.
void LeaveOneOutQr::hand_down(const Node& parent, Node& child, int out_first, int out_last,
                              double lambda, double weight) {
  const double* left = parent.factor.left();
  const auto columns_at = [&](int block) { return left + (block - parent.first) * block_columns_; };
  const int kept = child.last - child.first;
  double* out = child.factor.row();
  out = std::copy_n(columns_at(out_first), (out_last - out_first) * block_columns_, out);
  out = std::copy_n(columns_at(child.first), kept == 1 ? 1 : kept * block_columns_, out);
  std::copy_n(columns_at(parent.last), responses_, out);
  take(child, lambda, weight, magnitudes_.data() + lead_in_ + out_first * block_columns_);
}

}  // namespace mpm
