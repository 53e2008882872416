#include "core/regression/leave_one_out_qr.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "tests/core/counter_noise.hpp"

namespace mpm {
namespace {

TEST_CASE("leaving one block out of a shared tree equals a factor of its own per block") {
  // Expected: GivensQr of everything but the block, whose own test compares it with Householder.
  constexpr int kBlockColumns = 5;
  constexpr int kResponses = 7;
  constexpr double kLambda = 0.99;
  for (const int blocks : {1, 2, 3, 4, 5, 7}) {
    const int columns = 1 + blocks * kBlockColumns;
    LeaveOneOutQr tree(1, blocks, kBlockColumns, kResponses, kLambda);
    std::vector<GivensQr> separate;
    separate.reserve(static_cast<std::size_t>(blocks));
    for (int i = 0; i < blocks; ++i)
      separate.emplace_back(1 + (blocks - 1) * kBlockColumns, 1 + kResponses);
    std::vector<double> row(static_cast<std::size_t>(columns + kResponses));
    for (int k = 0; k < 500; ++k) {
      for (std::size_t c = 0; c < row.size(); ++c) row[c] = c == 0 ? 1.0 : test::coloured(c, k);
      if (blocks > 1) row[6] = row[1] + 1e-3 * row[6];  // nearly collinear blocks
      std::copy(row.begin(), row.end(), tree.row());
      tree.update();
      for (int i = 0; i < blocks; ++i) {
        const auto block = row.begin() + 1 + i * kBlockColumns;
        double* out = separate[static_cast<std::size_t>(i)].row();
        out = std::copy(row.begin(), block, out);
        out = std::copy(block + kBlockColumns, row.begin() + columns, out);
        *out++ = *block;
        std::copy(row.begin() + columns, row.end(), out);
        separate[static_cast<std::size_t>(i)].update(kLambda);
      }
    }
    for (int i = 0; i < blocks; ++i) {
      const GivensQr& expected = separate[static_cast<std::size_t>(i)];
      for (int r = 0; r <= kResponses; ++r) {
        CAPTURE(blocks, i, r);
        CHECK(tree.residual_squares(i)[r] == Approx(expected.residual_square(r)).epsilon(1e-10));
        const double scale = std::sqrt(expected.residual_square(0) * expected.residual_square(r));
        CHECK(std::abs(tree.residual_products(i)[r] - expected.residual_product(r)) <=
              1e-10 * scale);
      }
    }
  }
}

TEST_CASE("a block that the others make up entirely is left without movement") {
  LeaveOneOutQr tree(1, 3, 4, 1, 0.99);
  for (int k = 0; k < 300; ++k) {
    double* out = tree.row();
    *out++ = 1.0;
    for (std::uint64_t c = 1; c <= 8; ++c) *out++ = test::coloured(c, k);
    for (std::uint64_t c = 1; c <= 4; ++c)
      *out++ = test::coloured(c, k) + 2.0 * test::coloured(c + 4, k);
    *out = test::coloured(20, k);
    tree.update();
  }
  for (int i = 0; i < 3; ++i) CHECK(tree.residual_squares(i)[0] < 1e-24);
}

}  // namespace
}  // namespace mpm
