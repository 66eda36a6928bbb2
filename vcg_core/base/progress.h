// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Progress reports and cancellation of long operations.
#pragma once

#include <algorithm>

namespace neuralmesh {

/// Interface of progress reports. Long operations call it on the calling thread only: about every thousand
/// signals of learning, in every round of the fit and at every stage of the start mesh.
class Progress {
public:
    virtual ~Progress() = default;

    /// \param fraction of the whole run done so far, in [0, 1], never decreasing
    /// \param text     current activity and its figures
    /// \return false to cancel: the operation then ends early and returns the valid mesh it has
    virtual bool operator()(double fraction, const char* text) = 0;
};

/// Ignores all reports and never cancels.
class NoProgress : public Progress {
public:
    bool operator()(double /*fraction*/, const char* /*text*/) override { return true; }
};

/// Maps the progress of a part, 0 to 1, to the range from .. to of the whole.
class PartOf : public Progress {
public:
    PartOf(Progress& whole, double from, double to) : whole_(whole), from_(from), to_(to) {}
    bool operator()(double fraction, const char* text) override {
        return whole_(std::min(from_ + fraction * (to_ - from_), to_), text);
    }

private:
    Progress& whole_;
    double from_;
    double to_;
};

/// Thrown by EndingProgress.
struct Stopped {};

/// For stages that have nothing to return before they are done: a request to stop ends them by an exception.
class EndingProgress : public Progress {
public:
    explicit EndingProgress(Progress& caller) : caller_(caller) {}
    bool operator()(double fraction, const char* text) override {
        if (!caller_(fraction, text)) throw Stopped();
        return true;
    }

private:
    Progress& caller_;
};

/// For a run whose parts may repeat: fractions never decrease, and a request to stop is remembered.
class MonotoneProgress : public Progress {
public:
    explicit MonotoneProgress(Progress& caller) : caller_(caller) {}
    bool operator()(double fraction, const char* text) override {
        done_ = std::max(done_, fraction);
        stopped_ = stopped_ || !caller_(done_, text);
        return !stopped_;
    }
    bool stopped() const { return stopped_; }

private:
    Progress& caller_;
    double done_ = 0;
    bool stopped_ = false;
};

}  // namespace neuralmesh
