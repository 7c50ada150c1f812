// SPDX-License-Identifier: Apache-2.0
#include "tests/simd/determinants.h"

#include <array>

#include "pellucid/math/determinant.h"
#include "tests/math/determinant_cases.h"
#include "tests/simd/every_instruction_set.h"

/// That meshes have no cracks wants one answer to one question, whoever asks: the sign is exact in
/// every lane, whatever the neighbours are.
namespace pellucid::test {
namespace {

class Determinants : public EveryInstructionSet {
 protected:
  template <class T>
  static void expect_exact(void (*run)(const T* const in[4], T* out), std::size_t lanes) {
    std::vector<DeterminantCase<T>> all = determinant_cases<T>(24000);
    all.resize(all.size() / lanes * lanes);
    for (std::size_t i = 0; i < all.size(); i += lanes) {
      std::array<std::array<T, 16>, 4> in;
      for (std::size_t l = 0; l < lanes; ++l) {
        const DeterminantCase<T>& c = all[i + l];
        in[0][l] = c.a_x;
        in[1][l] = c.a_y;
        in[2][l] = c.b_x;
        in[3][l] = c.b_y;
      }
      const T* const rows[4] = {in[0].data(), in[1].data(), in[2].data(), in[3].data()};
      const T* const exchanged[4] = {rows[2], rows[3], rows[0], rows[1]};
      T found[16], opposite[16];
      run(rows, found);
      run(exchanged, opposite);
      for (std::size_t l = 0; l < lanes; ++l) {
        const DeterminantCase<T>& c = all[i + l];
        ASSERT_EQ((found[l] > 0) - (found[l] < 0), c.sign()) << c.text();
        ASSERT_LE(c.error_of(found[l]), 2) << c.text();
        ASSERT_EQ(opposite[l], -found[l]) << c.text();
      }
    }
  }
};
PELLUCID_EVERY_INSTRUCTION_SET(Determinants);

TEST_P(Determinants, HaveTheExactSignInEveryLane) {
  const simd_determinants::Table& table = *choose(PELLUCID_ENTRIES(pellucid_simd_determinants))();
  const auto lanes = static_cast<std::size_t>(table.lanes);
  expect_exact<double>(table.twice, lanes);
  expect_exact<float>(table.single, lanes);
}

}  // namespace
}  // namespace pellucid::test
