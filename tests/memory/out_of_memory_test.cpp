// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Allocations of a run that fail: the caller gets the message about memory, the input is unchanged, nothing
// leaks, and the next run gives its usual bytes. Only a sample of the allocations is tried;
// NEURALMESH_MEMORY_TRIES=1000 enlarges it.
#include <atomic>
#include <new>

#include "allocations.h"
#include "filter_neuralmesh/actions.h"
#include "tests/unit/support/layer_mesh.h"
#include "tests/unit/support/referee.h"
#include "vcg_core/base/parallel_for.h"

namespace neuralmesh::out_of_memory_test {

using allocations::Failure;
using layer_mesh::Mesh;
using layer_mesh::Vertex;

/// The memory of a mesh's elements, byte by byte.
std::string bytes_of(const Mesh& mesh) {
    const auto raw = [](const auto& elements) {
        return std::string(reinterpret_cast<const char*>(elements.data()),
                           elements.size() * sizeof(elements[0]));
    };
    return raw(mesh.vert) + raw(mesh.face) + std::to_string(mesh.vn) + " " + std::to_string(mesh.fn);
}

vcg::Matrix44f identity() {
    vcg::Matrix44f matrix;
    matrix.SetIdentity();
    return matrix;
}

/// Learns a layer and writes the result, as the filter does. \return the error message, empty if there is
/// none
std::string filter(const Mesh& layer, const Settings& settings, Mesh& out) {
    try {
        const NeuralMesh result = run(layer, identity(), settings, true, {}, nullptr);
        write_mesh(result, settings, out);
        log_lines(result.report);
        return {};
    } catch (...) {
        return sentence_of_current_exception();
    }
}

/// Settings of short runs that together pass through all parts of the core.
std::vector<Settings> variants() {
    Settings shell;
    shell.target_vertices = 60;
    shell.settling_signals_per_vertex = 0;
    shell.threads = 2;
    shell.select_features = true;
    Settings to_the_paper = shell;
    to_the_paper.start_mesh = kTetrahedron;
    to_the_paper.feature_measure = kCreaseMeasure;
    to_the_paper.select_by = kFeatureCounter;
    to_the_paper.draw_from_faces = false;
    return {shell, to_the_paper};
}

/// The \p first of \p all allocations, and a random one, which depends on \p salt, out of each of \p tries
/// equal parts of the others: a loop with regular allocations then fails at different lines.
std::vector<long long> sampled(long long all, int first, int tries, std::uint64_t salt) {
    std::vector<long long> result(static_cast<std::size_t>(first));
    std::iota(result.begin(), result.end(), 0);
    Random random(salt);
    const auto start_of = [&](int part) { return first + part * (all - first) / tries; };
    for (int i = 0; i < tries; ++i) {
        const long long size = std::max(start_of(i + 1) - start_of(i), 1LL);
        result.push_back(start_of(i) + random.below(static_cast<std::uint32_t>(size)));
    }
    return result;
}

void expect_the_sentence_where_it_fails(const Settings& settings, Failure failure, const std::string& words,
                                        std::uint64_t salt) {
    Mesh layer;
    layer_mesh::fill(layer, shapes::icosphere(3), true);
    const std::string before = bytes_of(layer);
    std::string expected;
    long long all = 0;
    {
        Mesh out;
        allocations::fail_at(-1);
        ASSERT_EQ(filter(layer, settings, out), "");
        all = allocations::count();
        expected = bytes_of(out).substr(0, out.vert.size() * sizeof(Vertex));
    }
    ASSERT_GT(all, 200);
    int refused = 0;
    constexpr int kFirst = 10;
    const int tries = number_from("NEURALMESH_MEMORY_TRIES", 5, 1);
    for (const long long nth : sampled(all, kFirst, tries, salt)) {
        SCOPED_TRACE(testing::Message() << "allocation " << nth << " of " << all);
        const long long living = allocations::living();
        {
            Mesh out;
            allocations::fail_at(nth, failure);
            const std::string sentence = filter(layer, settings, out);
            allocations::fail_at(-1);
            // A failure to start a thread is tolerated, every other one is reported.
            if (!sentence.empty()) {
                ++refused;
                EXPECT_NE(sentence.find(words), std::string::npos) << sentence;
                EXPECT_EQ(sentence.back(), '.');
            } else {
                EXPECT_EQ(bytes_of(out).substr(0, out.vert.size() * sizeof(Vertex)), expected);
            }
        }
        EXPECT_EQ(allocations::living(), living) << "blocks have leaked";
        ASSERT_EQ(bytes_of(layer), before);
        if (testing::Test::HasFailure()) return;
    }
    EXPECT_GT(refused, kFirst);
    Mesh out;
    EXPECT_EQ(filter(layer, settings, out), "");
    EXPECT_EQ(bytes_of(out).substr(0, out.vert.size() * sizeof(Vertex)), expected);
}

TEST(OutOfMemory, OneFailedAllocationIsReported) {
    std::uint64_t salt = 0;
    for (const Settings& settings : variants())
        expect_the_sentence_where_it_fails(settings, Failure::once,
                                           "There is not enough memory for this mesh", ++salt);
}

TEST(OutOfMemory, ExhaustedMemoryIsReported) {
    std::uint64_t salt = 100;
    for (const Settings& settings : variants())
        expect_the_sentence_where_it_fails(settings, Failure::from_then_on, "Out of memory.", ++salt);
}

TEST(OutOfMemory, ALoopRunsOnTheThreadsThereAre) {
    constexpr int kChunks = 50;
    const auto loop = [] {
        std::array<std::atomic<int>, kChunks> done{};
        ThreadTeam team(4);
        for_chunks(kChunks, 1, team, [&](std::size_t chunk, std::size_t, std::size_t) { ++done[chunk]; });
        return std::all_of(done.begin(), done.end(), [](const auto& times) { return times == 1; });
    };
    allocations::fail_at(-1);
    EXPECT_TRUE(loop());
    const long long all = allocations::count();
    int carried_on = 0;
    for (long long nth = 0; nth < all; ++nth) {
        SCOPED_TRACE(nth);
        bool whole = false;
        bool refused = false;
        allocations::fail_at(nth);
        try {
            whole = loop();
        } catch (const std::bad_alloc&) {
            refused = true;
        }
        allocations::fail_at(-1);
        EXPECT_NE(whole, refused);
        carried_on += whole ? 1 : 0;
    }
    EXPECT_GE(carried_on, 3);
}

// Operations that run out of memory leave the network unchanged.

/// Tries \p change on \p network with the first, the second, ... allocation failing, until it succeeds.
/// \return the number of failures
template <class Change>
int failures_before(Network& network, const Change& change) {
    const int vertices = network.vertex_count();
    const std::vector<Triangle> faces = network.faces();
    for (int nth = 0;; ++nth) {
        allocations::fail_at(nth);
        try {
            change();
            allocations::fail_at(-1);
            return nth;
        } catch (const std::bad_alloc&) {
            allocations::fail_at(-1);
        }
        EXPECT_EQ(network.validate(), "") << nth;
        EXPECT_EQ(network.vertex_count(), vertices);
        EXPECT_EQ(network.faces(), faces);
    }
}

TEST(OutOfMemory, AFailedSplitChangesNothing) {
    Network network = network_of(shapes::icosphere(1));
    int failures = 0;
    for (VertexId v = 0; v < 12; ++v) {
        ASSERT_TRUE(network.can_split(v, 0, 3));
        failures += failures_before(network, [&] { network.split(v, 0, 3, network.position(v)); });
        ASSERT_EQ(network.validate(), "");
        EXPECT_EQ(network.position(network.slot_count() - 1), network.position(v));
    }
    EXPECT_GE(failures, 2);
    EXPECT_EQ(network.vertex_count(), 54);
}

TEST(OutOfMemory, AFailedCollapseChangesNothing) {
    for (const bool with_gaps : {false, true}) {
        Network network = network_of(shapes::icosphere(1));
        if (with_gaps) {
            std::vector<VertexId> order = morton_order(network);
            order.insert(order.begin(), -1);
            network.renumber(order);
        }
        int failures = 0;
        for (const VertexId v : network.vertices()) {
            if (!network.can_collapse(v, network.ring(v)[0])) continue;
            failures += failures_before(network, [&] { network.collapse(v, network.ring(v)[0]); });
            ASSERT_EQ(network.validate(), "");
        }
        EXPECT_EQ(failures > 0, !with_gaps) << "one word holds all these gaps";
    }
}

}  // namespace neuralmesh::out_of_memory_test
