// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The exceptions of the core. Every message consists of full sentences: what is wrong with which input, and
// what the user can do about it.
#pragma once

#include <stdexcept>

namespace neuralmesh {

/// Base class of all errors of the core. what() can be shown to the user.
class Error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A parameter is out of its range or contradicts another one.
class SettingError : public Error {
public:
    using Error::Error;
};

/// The given cloud or mesh cannot be learned.
class InputError : public Error {
public:
    using Error::Error;
};

/// A mesh or an operation on a network that violates the manifold conditions.
class TopologyError : public Error {
public:
    using Error::Error;
};

}  // namespace neuralmesh
