// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Whether the points of a cloud lie on the two sides of thin walls, or on one layer as in a single scan.
#pragma once

#include "vcg_core/target/cloud_survey.h"

namespace neuralmesh {

/// The share of places of the cloud that have a second layer of points above or below them, up to some eight
/// spacings away, with nothing between: the other side of a thin wall, or of a narrow gap. Layers less than
/// some three spacings apart, or closer than the noise lets tell, count as one. Estimated from 500 places.
/// O(places x 1,000 points).
double share_with_opposite_layer(const CloudSurvey& survey);

}  // namespace neuralmesh
