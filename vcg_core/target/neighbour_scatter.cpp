// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/target/neighbour_scatter.h"

namespace neuralmesh {

Eigen::Matrix3d neighbour_scatter(const NearestPoints& cloud, NearestPoints::Place place,
                                  const std::vector<NearestPoints::Neighbour>& near) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    for (const NearestPoints::Neighbour& n : near) {
        const vcg::Point3f d = cloud.point(n.place) - cloud.point(place);
        const Eigen::Vector3d p(static_cast<double>(d[0]), static_cast<double>(d[1]),
                                static_cast<double>(d[2]));
        sum += p;
        squares += p * p.transpose();
    }
    return squares - sum * sum.transpose() / (static_cast<double>(near.size()) + 1);
}

}  // namespace neuralmesh
