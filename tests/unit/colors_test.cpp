// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Vertex colours: from those of a cloud, by the plain slow computation, and from counters.
#include "tests/unit/support/runs.h"
#include "vcg_core/output/vertex_colors.h"

namespace neuralmesh::colors_test {

// Vertex colours from those of a cloud: the plain slow computation, and places without points.

constexpr Color kRed{255, 0, 0}, kBlue{0, 0, 255};

unsigned char code(double value) {
    return static_cast<unsigned char>(std::lround(std::clamp(value, 0.0, 255.0)));
}

/// Waves of the full range of codes, with the given period along each axis.
Color wavy(const vcg::Point3d& p, double period) {
    const auto wave = [&](int k) {
        return code(127.5 * (1 + std::sin(6.283185307179586 * p[k] / period + k)));
    };
    return {wave(0), wave(1), wave(2)};
}

template <class ColorAt>
TargetSpace colored(const Cloud& cloud, const ColorAt& color_at) {
    TargetSpace target = target_of(cloud);
    std::vector<Color> colors;
    for (const vcg::Point3d& p : cloud) colors.push_back(color_at(p));
    target.set_colors(colors);
    return target;
}

PerVertex<Color> colors_of(const TargetSpace& target, const Network& network, int threads = 2) {
    Random random(1);
    return cloud_colors(target, network, threads, random, unwatched());
}

TEST(CloudColors, DoNotDependOnTheThreads) {
    const Shape sphere = shapes::icosphere(3);
    const TargetSpace target =
        colored(shapes::sphere_cloud(50000), [](const vcg::Point3d& p) { return wavy(p, 1); });
    const Network network = network_in_frame(target, sphere);
    EXPECT_EQ(colors_of(target, network, 1), colors_of(target, network, 3));
}

/// Every point with its barycentric coordinates on the nearest of all faces.
struct Attached {
    Triangle face;
    std::array<float, 3> weights;
    Color color;
};

std::vector<Attached> attached(const TargetSpace& target, const Surface& surface) {
    std::vector<Attached> result;
    for (std::size_t i = 0; i < target.positions().size(); ++i) {
        const Hit hit = nearest_face(to_eigen(target.positions()[i]), surface.positions, surface.faces);
        result.push_back({surface.faces[hit.face], hit.foot.weights, target.colors()[i]});
    }
    return result;
}

/// Adds to the values the weighted mean of what is left of the points' colours without them.
std::vector<double> improved(const std::vector<double>& values, const std::vector<Attached>& points,
                             std::size_t channel) {
    std::vector<double> sums(values.size()), weights(values.size());
    for (const Attached& p : points) {
        double left = p.color[channel];
        for (std::size_t k = 0; k < 3; ++k)
            left -= static_cast<double>(p.weights[k]) * values[static_cast<std::size_t>(p.face[k])];
        for (std::size_t k = 0; k < 3; ++k) {
            sums[static_cast<std::size_t>(p.face[k])] += static_cast<double>(p.weights[k]) * left;
            weights[static_cast<std::size_t>(p.face[k])] += static_cast<double>(p.weights[k]);
        }
    }
    for (std::size_t v = 0; v < values.size(); ++v) sums[v] = values[v] + sums[v] / weights[v];
    return sums;
}

TEST(CloudColors, AreThoseOfThePlainComputation) {
    const Shape sphere = shapes::icosphere(1);
    const TargetSpace target =
        colored(shapes::sphere_cloud(1000, 0.05), [](const vcg::Point3d& p) { return wavy(p, 1); });
    const Network network = network_in_frame(target, sphere);
    const auto found = colors_of(target, network);
    const std::vector<Attached> points = attached(target, Surface(network));
    for (std::size_t channel = 0; channel < 3; ++channel) {
        std::vector<double> values(sphere.positions.size(), 0);
        for (int time = 0; time < 2; ++time) values = improved(values, points, channel);
        for (std::size_t v = 0; v < values.size(); ++v)
            EXPECT_NEAR(found[static_cast<int>(v)][channel], code(values[v]), 1) << v;
    }
}

/// Points over the lower half of a sphere only, and beside it a second sphere without any.
TEST(CloudColors, SpreadToVerticesWithoutPoints) {
    Cloud cloud;
    for (const vcg::Point3d& p : shapes::sphere_cloud(20000))
        if (p[2] < 0) cloud.push_back(p);
    const TargetSpace target = colored(cloud, [](const vcg::Point3d& p) { return p[0] < 0 ? kRed : kBlue; });
    Shape both = shapes::icosphere(3);
    const int vertices = static_cast<int>(both.positions.size());
    shapes::append(both, shapes::icosphere(1), {9, 0, 0});
    const auto found = colors_of(target, network_in_frame(target, both));
    for (int v = 0; v < found.size(); ++v) {
        const double x = both.positions[static_cast<std::size_t>(v)][0];
        if (v >= vertices) {
            EXPECT_EQ(found[v], (Color{255, 255, 255})) << v;
        } else if (std::abs(x) > 0.5) {
            EXPECT_EQ(found[v], x < 0 ? kRed : kBlue) << v;
        }
    }
}

TEST(CloudColors, OfFacesAreInterpolatedBetweenTheirCorners) {
    const Shape box = shapes::cube();
    TargetSpace target = target_of(box);
    std::vector<Color> colors;
    const auto shade = [](double x) { return code(128 + 100 * x); };
    for (const auto& face : box.faces)
        for (const int v : face) {
            const vcg::Point3d& p = box.positions[static_cast<std::size_t>(v)];
            colors.push_back({shade(p[0]), shade(p[1]), shade(p[2])});
        }
    target.set_colors(colors);
    Shape finer = shapes::icosphere(4);
    for (vcg::Point3d& p : finer.positions)
        p /= 2 * std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
    const auto found = colors_of(target, network_in_frame(target, finer));
    for (int v = 0; v < found.size(); ++v)
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(found[v][static_cast<std::size_t>(k)],
                        shade(finer.positions[static_cast<std::size_t>(v)][k]), 6);
}

TEST(CloudColors, AreWholeIfStopped) {
    const Shape sphere = shapes::icosphere(3);
    const TargetSpace target = colored(shapes::sphere_cloud(70000), [](const auto&) { return kBlue; });
    Watch stop(0);
    Random random(1);
    const auto found = cloud_colors(target, network_in_frame(target, sphere), 1, random, stop);
    for (const Color& color : found) EXPECT_EQ(color, kBlue);
}

// Vertex colours that show the feature measure: light where it is small, the ends at two percentiles.

/// 0, 1, ..., 100: each value is its own percentile.
std::vector<float> hundred_and_one() {
    std::vector<float> counters(101);
    std::iota(counters.begin(), counters.end(), 0.0F);
    return counters;
}

/// Relative luminance by ITU-R BT.709, without its transfer function.
double luminance(const Color& c) { return (0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]) / 255; }

TEST(CounterColors, GetDarkerAsCountersGrow) {
    const std::vector<Color> colors = counter_colors(hundred_and_one());
    ASSERT_EQ(colors.size(), 101U);
    for (std::size_t i = 3; i <= 98; ++i) EXPECT_LT(luminance(colors[i]), luminance(colors[i - 1])) << i;
}

TEST(CounterColors, AreReadableOnAShadedSurface) {
    const std::vector<Color> colors = counter_colors(hundred_and_one());
    EXPECT_GT(luminance(colors.front()), 0.9);
    EXPECT_GT(luminance(colors.back()), 0.2);
}

TEST(CounterColors, EndAtThePercentiles) {
    std::vector<float> counters = hundred_and_one();
    const std::vector<Color> colors = counter_colors(counters);
    EXPECT_EQ(colors[0], colors[2]);
    EXPECT_NE(colors[2], colors[3]);
    EXPECT_NE(colors[97], colors[98]);
    EXPECT_EQ(colors[98], colors[100]);
    counters[100] = 1e30F;
    EXPECT_EQ(counter_colors(counters), colors) << "one extreme counter changed the others' colours";
}

TEST(CounterColors, AreLightIfAllCountersAreEqual) {
    EXPECT_TRUE(counter_colors({}).empty());
    const std::vector<Color> colors = counter_colors({5, 5, 5});
    EXPECT_EQ(colors, std::vector<Color>(3, counter_colors(hundred_and_one()).front()));
}

}  // namespace neuralmesh::colors_test
