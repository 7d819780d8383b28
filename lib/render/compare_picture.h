// The report of a comparison as one picture.
#pragma once

#include "lib/diag/compare.h"
#include "lib/render/renderer.h"

namespace pbf {

/// 1280 x 800: verdicts, the error of every stage against its tolerance, the first diagram.
Image compare_picture(const CompareResult& result);

}  // namespace pbf
