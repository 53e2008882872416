#pragma once

#include <cstddef>
#include <vector>

#include "core/regression/givens_qr.hpp"
#include "core/regression/row_batch.hpp"

namespace mpm {

class Archive;

/// For each of m blocks of regressors: what the regression on everything but this block leaves of
/// the block's first column and of the common responses. Rows are
///
///     [lead-in | block 0 | ... | block m-1 | responses],
///
/// weighted by lambda^age. As m separate factors this would eliminate the same columns over and
/// over; instead the factors share what they have in common, in a tree: the root eliminates the
/// lead-in; a node that has everything but the blocks a..b eliminated hands what is left of each
/// row to two nodes, one of which goes on to eliminate the first half of a..b and one the second
/// half; a leaf has one block left. Orthogonal throughout (GivensQr): no factor is ever undone.
///
/// Cost per row: about 4 flops for each of (log2 m) m b (m b / 2 + responses) entries, against
/// m (m b) (m b / 2 + responses) of separate factors. No allocation after construction.
class LeaveOneOutQr {
 public:
  /// All > 0; responses may be 0. At each row everything before is weighted by lambda
  /// (0 < lambda <= 1).
  LeaveOneOutQr(int lead_in, int blocks, int block_columns, int responses, double lambda);

  /// Where the caller writes the next row, all of it.
  [[nodiscard]] double* row() { return rows_.row(waiting_); }
  /// Takes the row. Rows wait for each other, with the same bits, until the residuals are read or
  /// no more can wait.
  void update();

  /// Residual sums of squares, given all other blocks, of a block's first column and then of each
  /// response; and of products of the first column's residual with each of them.
  [[nodiscard]] const double* residual_squares(int block) {
    fold();
    return leaf(block).residual_squares();
  }
  [[nodiscard]] const double* residual_products(int block) {
    fold();
    return leaf(block).residual_products();
  }

  void archive(Archive& a);

 private:
  /// Everything but the blocks first..last-1 is eliminated, by this factor and those above it.
  struct Node {
    int first, last;
    GivensQr factor;  // responses: what is left of those blocks, or, of one, its first column
    std::size_t low = 0, high = 0;  // nodes that keep the first and the second half of them
    void archive(Archive& a);
  };
  /// What the nodes of one depth have in hand: one after the other, so they share it.
  struct Level {
    RowBatch rows;
    std::vector<double> weights;
  };
  std::size_t add_node(int first, int last, int columns, std::size_t depth);
  void fold();
  void take(Node& node, std::size_t depth, const double* magnitudes);
  void hand_down(const Node& parent, Node& child, int out_first, int out_last, std::size_t depth);
  [[nodiscard]] const GivensQr& leaf(int block) const {
    return nodes_[leaves_[static_cast<std::size_t>(block)]].factor;
  }

  int lead_in_;
  int block_columns_;
  int responses_;
  double lambda_;
  std::vector<double> magnitudes_;  // per column, largest |x| seen, forgotten with sqrt(lambda)
  RowBatch rows_;                   // that wait
  int waiting_ = 0;
  std::vector<double> waiting_magnitudes_;  // per row that waits: magnitudes_ as of it
  std::vector<Node> nodes_;                 // the root first
  std::vector<std::size_t> leaves_;
  std::vector<Level> levels_;
};

}  // namespace mpm
