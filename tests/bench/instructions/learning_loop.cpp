// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A small fixed run of the learning loop, for callgrind to count its instructions: a sphere's cloud made
// without any transcendental function, 2,562 vertices that grow to 2,800 and settle. Prints the number of
// signals.
#include <iostream>

#include "tests/unit/support/referee.h"
#include "vcg_core/learning/learner.h"

int main() {
    using namespace neuralmesh;
    const TargetSpace target = target_of(shapes::sphere_cloud(20000, 0.01));
    LearnerOptions options;
    options.grow_to = 2800;
    options.settling_signals_per_vertex = 1;
    options.threads = 1;  // waiting for each other costs instructions, too
    Learner learner(target, options, network_in_frame(target, shapes::icosphere(4)));
    NoProgress progress;
    learner.run(0, progress);
    std::cout << learner.signals() << '\n';
    return learner.network().vertex_count() == options.grow_to ? 0 : 1;
}
