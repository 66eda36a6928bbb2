// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Which thread computes which Basic Steps and moves which vertices: space is cut into slabs across one axis,
// one slab per thread, as long as all threads together are faster than one.
#pragma once

#include <vcg/space/point3.h>

#include <chrono>
#include <vector>

#include "vcg_core/base/indexed.h"
#include "vcg_core/base/thread_team.h"
#include "vcg_core/engine/winner_search.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// Slabs across the longest axis of a sample, each with equally many of its points.
class AxisPartition {
public:
    /// Starts with one slab, all of space. \p sample may be empty. O(n log n) for n points.
    explicit AxisPartition(const std::vector<vcg::Point3f>& sample);

    /// Replaces the slabs by \p count new ones, at least 1. O(count).
    void cut(int count);
    int count() const { return static_cast<int>(borders_.size()) - 1; }

    /// The points p with begin <= p[axis] < end.
    struct Range {
        int axis;
        float begin;
        float end;

        bool holds(const vcg::Point3f& p) const {
            return static_cast<int>(begin <= p[axis]) & static_cast<int>(p[axis] < end);  // without a branch
        }
    };
    Range range(int slab) const {
        const auto i = static_cast<std::size_t>(slab);
        return {axis_, borders_[i], borders_[i + 1]};
    }
    /// The slab that holds p. O(count). \pre p is finite
    int of(const vcg::Point3f& p) const;

private:
    int axis_ = 0;
    std::vector<float> coordinates_;  ///< of the sample along the axis, in rising order
    std::vector<float> borders_;      ///< slab i reaches from borders_[i] to borders_[i + 1]
};

/// Times batches on one thread and on all, periodically, and chooses the faster: it depends on inter-core
/// latency and load. A batch that was interrupted does not decide. The choice does not change what is
/// computed.
class ThreadTiming {
public:
    /// Whether to run the next batch on all threads.
    bool use_all_threads() const;
    /// Reports the duration of that batch.
    void add_batch(double nanoseconds_per_signal);

private:
    int batch_ = 0;                   ///< since the last trial began
    std::vector<double> one_thread_;  ///< the timed batches of the trial, in ns per signal
    std::vector<double> all_threads_;
    bool all_are_faster_ = false;  ///< in the last trial
};

/// Cuts space into slabs, one per thread. A thread computes the steps of the signals in its slab and alone
/// moves the vertices that belong to it, so those stay in the cache of its core. A vertex belongs to the slab
/// that it lay in when slabs were last assigned; Ring::tag holds the number of that slab.
class SlabSchedule {
public:
    /// \p threads: 0 for as many as the machine has. Slabs are cut so that each holds equally many of
    /// \p typical_signals.
    SlabSchedule(int threads, const std::vector<vcg::Point3f>& typical_signals)
        : team_(thread_count(threads)), partition_(typical_signals) {}

    ThreadTeam& team() { return team_; }
    int max_slabs() const { return team_.members(); }
    /// Number of slabs, and of threads, of the present batch.
    int slabs() const { return slabs_; }

    /// Chooses the number of slabs for a batch of \p count signals: 1 or as many as there are threads. If
    /// slabs have changed, assigns every vertex to one and splits the table of \p search between the first
    /// half of them and the second. O(1), O(vertices) after a change.
    void begin_batch(int count, Network& network, WinnerSearch& search);
    void end_batch();
    /// Assigns slabs again, and times threads again, before the next batch.
    void reassign() { assigned_ = false; }

    /// Calls \p body(slab) for all slabs, in parallel.
    template <class Body>
    void parallel(const Body& body) {
        team_.parallel(slabs_, [&](int /*member*/, int slab) { body(slab); });
    }
    /// ThreadTeam::run_in_background(), if the present batch has more than one thread; else does nothing.
    template <class Body>
    ThreadTeam::BackgroundTask run_in_background(const Body& body) {
        return slabs_ > 1 ? team_.run_in_background(body) : ThreadTeam::BackgroundTask();
    }

    /// Writes the indices of the signals that lie in \p slab to the start of \p indices, which must have at
    /// least \p count elements, in rising order. \return how many they are. O(count).
    int signals_in(int slab, const vcg::Point3f* signals, int count, Indexed<int>& indices) const;

private:
    ThreadTeam team_;
    ThreadTiming timing_;
    AxisPartition partition_;
    bool assigned_ = false;  ///< every vertex has been assigned to a slab
    int slabs_ = 1;
    int count_ = 0;              ///< signals of the present batch
    bool worth_timing_ = false;  ///< the present batch could run on more than one thread
    std::chrono::steady_clock::time_point begin_;
};

/// Whether a Basic Step of \p winner moves only vertices of \p slab.
inline bool moves_only_in(const Network& network, VertexId winner, int slab) {
    const Ring& ring = network.ring(winner);
    int others = ring.tag ^ slab;
    for (const VertexId v : ring) others |= network.ring(v).tag ^ slab;
    return others == 0;
}

}  // namespace neuralmesh
