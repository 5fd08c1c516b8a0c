// Fewer triangles for a surface that is looked at from afar. Pure.
#pragma once

#include <cstddef>

#include "coordinator/models/packed_mesh.h"

namespace tcs {

// The surface with at most so many triangles, more than 0. Vertices at the same place become one,
// and if that is not enough, the vertices of each cell of a grid, whose cells are as small as can
// be: each vertex is then moved by less than a cell's diagonal. A triangle that has shrunk to a
// line is left out. `surface` is finite.
Surface Decimated(const Surface& surface, std::size_t most_triangles);

}  // namespace tcs
