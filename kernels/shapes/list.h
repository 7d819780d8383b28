// The shapes of solids, in the order of their names in scenes; an include and a name each. Included
// twice, because a shape has two files: kernels/shapes/NAME.h, and lib/scene/shapes/NAME.h for its
// description in scenes. PBF_SHAPE_FILE(name) selects one.
#include PBF_SHAPE_FILE(plane)
#include PBF_SHAPE_FILE(box)
#include PBF_SHAPE_FILE(sphere)
#include PBF_SHAPE_FILE(cylinder)
#include PBF_SHAPE_FILE(capsule)
#include PBF_SHAPE_FILE(mesh)
#undef PBF_SHAPE_FILE
#undef PBF_SHAPES
#define PBF_SHAPES Plane, Box, Sphere, Cylinder, Capsule, Mesh
