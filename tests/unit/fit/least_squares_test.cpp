// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The normal equations against their definition, and their solution against Eigen's direct solvers.
#include "vcg_core/fit/least_squares.h"

#include <Eigen/Dense>

#include "tests/unit/fit/fit_scene.h"

namespace neuralmesh::least_squares_test {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

double sine(Random& random) { return 0.02 * std::sin(50 * shapes::unit(random)); }

Vector flat(const PerVertex<Vector3>& values) {
    Vector result(3 * values.size());
    for (VertexId v = 0; v < values.size(); ++v) result.segment<3>(3 * v) = values[v].cast<double>();
    return result;
}

/// The matrix of the system, column by column.
Matrix matrix_of(const PointToPlaneSystem& system, int slots, float lambda) {
    Matrix matrix(3 * slots, 3 * slots);
    PerVertex<Vector3> unit(slots, Vector3::Zero());
    PerVertex<Vector3> column(slots, Vector3::Zero());
    for (VertexId v = 0; v < slots; ++v)
        for (Eigen::Index axis = 0; axis < 3; ++axis) {
            unit[v][axis] = 1;
            system.multiply(lambda, unit, one_thread(), column);
            unit[v][axis] = 0;
            matrix.col(3 * v + axis) = flat(column);
        }
    return matrix;
}

struct LeastSquares : testing::Test {
    Network network = network_of(shapes::icosphere(2), 0.02);
    Surface surface{network};
    PointsByFace points = points_on(surface, 12, sine);
    ThreadTeam team{2};
    PointToPlaneSystem system{network, surface, points, team};
};

TEST_F(LeastSquares, IsSolvedAsByDirectSolvers) {
    for (float lambda : {0.01F, 1.0F, 50.0F}) {
        const Matrix matrix = matrix_of(system, network.slot_count(), lambda);
        EXPECT_LT((matrix - matrix.transpose()).norm(), 1e-5 * matrix.norm());
        const Vector right_side = flat(system.right_side(lambda));
        const Vector dense = Eigen::LDLT<Matrix>(matrix).solve(right_side);
        const Vector exact = flat(system.solve({lambda}, team, {1e-6, 2000})[0]);
        EXPECT_LT((exact - dense).norm(), 1e-3 * dense.norm()) << lambda;
        // The fit needs an energy close to the minimum.
        const auto energy = [&](const Vector& u) { return (0.5 * u.dot(matrix * u) - u.dot(right_side)); };
        const Vector solved = flat(system.solve({lambda}, team)[0]);
        EXPECT_LT(energy(solved) - energy(dense), 1e-2 * -energy(dense)) << lambda;
    }
}

TEST(BendingWeights, HaveTheirBitsWhereThereIsABoundary) {
    const Network network = network_of(shapes::grid(32, 32), 0.02);
    const Surface surface(network);
    ThreadTeam team(2);
    const PerVertex<float> stiffness(network.slot_count(), 0.5F);
    const PointToPlaneSystem system(network, surface, points_on(surface, 12, sine), team, {stiffness, {}});
    ThreadTeam one(1), three(3);
    EXPECT_EQ(system.solve({0.01F, 1, 8}, one), system.solve({0.01F, 1, 8}, three));
}

// The energy of the points, without bending: sum of w ((n.e)^2 + h |e_t|^2), as the header defines.
TEST_F(LeastSquares, MeasuresThePointsAsDefined) {
    PointsByFace heavier = points;
    for (PointsByFace::Assignment& a : heavier.all()) a.influence = 3;
    Random random(8);
    PerVertex<Vector3> u(network.slot_count(), Vector3::Zero());
    for (Vector3& v : u) v = 0.1F * to_eigen(vcg::Point3f::Construct(shapes::in_cube(random)));
    double along_normals = 0, within_planes = 0;
    for (int f = 0; f < surface.face_count(); ++f)
        for (const PointsByFace::Assignment& a : points.of(f)) {
            const Eigen::Vector3d normal = unit_normal(surface, f).cast<double>();
            for (const double share : {0.0, 1.0}) {
                Eigen::Vector3d e = a.point.cast<double>();
                for (std::size_t k = 0; k < 3; ++k) {
                    const VertexId v = surface.faces[f][k];
                    e -= static_cast<double>(a.foot.weights[k]) *
                         (surface.positions[v].cast<double>() + share * u[v].cast<double>());
                }
                const double sign = share > 0 ? 1 : -1;
                const double along = normal.dot(e);
                along_normals += sign * along * along;
                within_planes += sign * (e - along * normal).squaredNorm();
            }
        }
    // Tripling the influence of all points adds twice their energy, and no bending.
    const auto energy = [&](const PointToPlaneSystem& s) {
        PerVertex<Vector3> image(u.size(), Vector3::Zero());
        s.multiply(0, u, team, image);
        return flat(u).dot(flat(image)) - 2 * flat(u).dot(flat(s.right_side(0)));
    };
    for (const float hold : {PointToPlaneSystem::kSliding, 0.3F, 1.0F}) {
        const PointToPlaneSystem light(network, surface, points, team, {}, hold);
        const PointToPlaneSystem heavy(network, surface, heavier, team, {}, hold);
        const double expected = along_normals + static_cast<double>(hold) * within_planes;
        EXPECT_NEAR((energy(heavy) - energy(light)) / 2, expected, 1e-3 * std::abs(expected));
    }
}

// Even stiffness adds to the bending weight.
TEST_F(LeastSquares, TakesStiffnessForBendingWeight) {
    constexpr float kStiffness = 3;
    const PerVertex<float> even(network.slot_count(), kStiffness);
    const PointToPlaneSystem stiff(network, surface, points, team, {even, {}});
    const Matrix expected = matrix_of(system, network.slot_count(), 0.5F + kStiffness);
    EXPECT_LT((matrix_of(stiff, network.slot_count(), 0.5F) - expected).norm(), 1e-5 * expected.norm());
    EXPECT_LT((flat(stiff.right_side(0.5F)) - flat(system.right_side(0.5F + kStiffness))).norm(),
              1e-4 * flat(system.right_side(0.5F + kStiffness)).norm());
    const PointToPlaneSystem::Accuracy exact{1e-6, 1000};
    const Vector solved = flat(stiff.solve({0.5F}, team, exact)[0]);
    EXPECT_LT((solved - flat(system.solve({0.5F + kStiffness}, team, exact)[0])).norm(),
              1e-3 * solved.norm());
}

// A plane has no bending energy, whatever the shapes of its triangles, and none after it is tilted.
TEST(BendingTerms, AreZeroOnAPlane) {
    Shape grid = shapes::grid(8, 8);
    Random random(9);
    for (vcg::Point3d& p : grid.positions) p += vcg::Point3d(0.02, 0.01, 0) * shapes::signed_unit(random);
    const Network network = network_of(grid);
    const Surface surface(network);
    const PointToPlaneSystem system(network, surface, points_on(surface, 10, sine), one_thread());
    const Vector without = flat(system.right_side(0));
    EXPECT_LT((flat(system.right_side(100)) - without).norm(), 1e-3 * without.norm());
    PerVertex<Vector3> tilt(network.slot_count(), Vector3::Zero());
    for (VertexId v : network.vertices())
        tilt[v][2] = 0.3F * surface.positions[v][0] - surface.positions[v][1] + 2;
    PerVertex<Vector3> bent = tilt;
    PerVertex<Vector3> plain = tilt;
    system.multiply(100, tilt, one_thread(), bent);
    system.multiply(0, tilt, one_thread(), plain);
    EXPECT_LT((flat(bent) - flat(plain)).norm(), 1e-3 * flat(plain).norm());
    // A bump has bending energy.
    tilt[40][2] += 1;
    system.multiply(100, tilt, one_thread(), bent);
    system.multiply(0, tilt, one_thread(), plain);
    EXPECT_GT((flat(bent) - flat(plain)).norm(), flat(plain).norm());
}

}  // namespace neuralmesh::least_squares_test
