// The shapes of solids, in the order of their words in scenes: an include and a name each. Included
// twice, for a shape has two files: kernels/shapes/NAME.h, and lib/scene/shapes/NAME.h for what
// scenes say of it. PBF_SHAPE_FILE(name) tells which.
#include PBF_SHAPE_FILE(plane)
#include PBF_SHAPE_FILE(box)
#include PBF_SHAPE_FILE(sphere)
#include PBF_SHAPE_FILE(cylinder)
#include PBF_SHAPE_FILE(capsule)
#undef PBF_SHAPE_FILE
#undef PBF_SHAPES
#define PBF_SHAPES Plane, Box, Sphere, Cylinder, Capsule
