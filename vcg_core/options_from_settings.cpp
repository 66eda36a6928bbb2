// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/options_from_settings.h"

namespace neuralmesh {

LearnerOptions learner_options_from(const Settings& settings) {
    LearnerOptions options;
    options.learning_rate = settings.learning_rate;
    options.smoothing_rate = settings.smoothing_rate;
    options.smoothing_steps = settings.smoothing_steps;
    options.signals_per_split = settings.signals_per_split;
    options.signals_per_collapse = settings.signals_per_collapse;
    options.counter_decay = settings.counter_decay;
    options.feature_decay = settings.feature_decay;
    options.normalization_window = settings.normalization_window;
    options.stop_below_turn = settings.stop_below_mean_counter;
    options.utility_increment =
        settings.utility_counter == kNormalVariation ? UtilityIncrement::n_delta : UtilityIncrement::one;
    options.grow_to = settings.target_vertices;
    options.min_wins_per_split = settings.min_wins_per_split;
    options.settling_signals_per_vertex = settings.settling_signals_per_vertex;
    options.observe_creases = settings.feature_measure == kCreaseMeasure;
    options.random_seed = settings.random_seed;
    options.threads = settings.threads;
    return options;
}

}  // namespace neuralmesh
