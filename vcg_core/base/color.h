// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Colours of points and vertices.
#pragma once

#include <array>

namespace neuralmesh {

using Color = std::array<unsigned char, 3>;  ///< red, green, blue, as files and screens have them

}  // namespace neuralmesh
