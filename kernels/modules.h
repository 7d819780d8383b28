// The modules are inline namespaces of pbf. They are declared inline here alone: the build includes
// this file before every source, and all other files open them by their names, without `inline`,
// which many tools that index sources do not understand.
#pragma once

// All arithmetic on particles is in this namespace. A second compilation under another name, for
// example with other floating-point options, can be linked beside the first, because its types and
// functions are distinct.
#ifndef PBF_VARIANT
#define PBF_VARIANT plain
#endif

namespace pbf {
inline namespace PBF_VARIANT {}
inline namespace app_module {}
inline namespace base_module {}
inline namespace campaign_module {}
inline namespace data_module {}
inline namespace exec_module {}
inline namespace io_module {}
inline namespace program_module {}
inline namespace render_module {}
inline namespace run_module {}
inline namespace scene_module {}
inline namespace solver_module {}
inline namespace verify_module {}
}  // namespace pbf
