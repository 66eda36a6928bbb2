// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The one exception family of the core. Every message is a full sentence: what is
// wrong, with which input, and what the user can do about it.
#pragma once

#include <stdexcept>

namespace neuralmesh {

/// Base of all errors the core throws; what() is fit to be shown to a user.
class Error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A parameter is out of its range or contradicts another.
class SettingError : public Error {
public:
    using Error::Error;
};

/// The cloud or mesh handed in cannot be learned.
class InputError : public Error {
public:
    using Error::Error;
};

/// A network operation was asked for that would break the manifold.
class TopologyError : public Error {
public:
    using Error::Error;
};

}  // namespace neuralmesh
