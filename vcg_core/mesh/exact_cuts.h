// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Which self-crossings are no accidents of rounding.
#pragma once

#include <vector>

#include "vcg_core/mesh/self_crossings.h"

namespace neuralmesh {

/// Drops those of \p crossings, of \p surface, whose faces do not go through each other. self_crossings()
/// finds some between faces that lie apart in one tilted plane, by the rounding of their corners: they hold
/// the fit back there a little, but no face may be removed for them. Faces that overlap in one plane do not
/// go through each other. O(crossings).
void drop_apparent(const Surface& surface, std::vector<SelfCrossing>& crossings);

}  // namespace neuralmesh
