// The report of a comparison as one picture.
#pragma once

#include "lib/render/renderer.h"
#include "lib/verify/compare.h"

namespace pbf::inline verify_module {

/// 1280 x 800: verdicts, the error of every stage against its tolerance, the first diagram.
Image compare_picture(const CompareResult& result);

}  // namespace pbf::inline verify_module
