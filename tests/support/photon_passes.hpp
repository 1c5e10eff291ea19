// What theory says of the mean of photon passes.
#pragma once

namespace photile::test {

/// What is left of bias and of the deviation by noise after n passes: the mean of the factors by
/// which the squared radius has shrunk, which falls as n^(-1/3).
inline double predicted_of_passes(int passes) {
  double factor = 1, sum = 0;
  for (int pass = 1; pass <= passes; ++pass) {
    sum += factor;
    factor *= (pass + 2.0 / 3.0) / (pass + 1.0);
  }
  return sum / passes;
}

}  // namespace photile::test
