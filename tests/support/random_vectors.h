// Random numbers and vectors, the same on every machine.
#pragma once

#include <random>

#include "kernels/vec3.h"

namespace pbf::test {

struct RandomVectors {
  std::mt19937 bits{5};
  double operator()(double low, double high) {
    return low + (high - low) * double(bits()) / double(bits.max());
  }
  Vec3<float> vector(double low, double high) {
    return {float((*this)(low, high)), float((*this)(low, high)), float((*this)(low, high))};
  }
};

}  // namespace pbf::test
