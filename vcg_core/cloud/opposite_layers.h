// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Places of a cloud, each with the layers of points opposite to it: whether the points lie on the two sides
// of thin walls, or on one layer as in a single scan.
#pragma once

#include <vcg/space/point3.h>

#include <vector>

#include "vcg_core/base/thread_team.h"
#include "vcg_core/cloud/surface_survey.h"

namespace neuralmesh {

/// A point of the cloud, the normal of the plane through its neighbours (of unit length, to either side), and
/// the distances of the layers above and below that plane, with nothing between; 0: there is none.
struct LayerPlace {
    vcg::Point3f position;
    vcg::Point3f normal;
    float above = 0;
    float below = 0;
    bool flat =
        false;  ///< the neighbours show a plane: they are no cloud of leaves, and not on one scan line
    bool on_thin_wall = false;  ///< flat, and one of the layers is at most some eight spacings away
};

/// About 1,000 places of the cloud, in the order of space. Opposite layers are looked for up to some twenty
/// spacings away: the other side of a wall, or of a gap. Layers less than some three spacings apart, or
/// closer than the noise lets tell, count as one. Points with too few neighbours for a plane are no places.
/// Does not depend on the number of threads. O(places x 2,000 points).
std::vector<LayerPlace> layer_places(const NearestPoints& cloud, ThreadTeam& team);

/// The share of \p places on thin walls. A layer within the radius on which the survey finds a surface is
/// noise of that surface, such as a step of a depth sensor, unless the points there lie in two layers alone.
/// \p surveys: of the same cloud; that of the surface is made only if there are places.
double share_on_thin_walls(const std::vector<LayerPlace>& places, Surveys& surveys);

}  // namespace neuralmesh
