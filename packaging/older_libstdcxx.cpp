// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Lets plugins compiled with GCC 11 and later load beside the libstdc++ of GCC 10 (GLIBCXX_3.4.28,
// CXXABI_1.3.12), the oldest of the supported MeshLab builds. Functions that the headers of later releases
// call, but that this one does not export, are defined here by functions that it does export.
//
// Linking libstdc++ statically would give the process a second state of exceptions, which cross the plugin's
// border.
#include <condition_variable>
#include <exception>
#include <mutex>
#include <new>

// Hidden: other code of the process keeps its own, and the loader cannot bind the names with versions below
// to them.
asm(".hidden _ZNSt18condition_variable4waitERSt11unique_lockISt5mutexE");
asm(".hidden _ZNSt15__exception_ptr13exception_ptr9_M_addrefEv");
asm(".hidden _ZNSt15__exception_ptr13exception_ptr10_M_releaseEv");
asm(".hidden _ZSt28__throw_bad_array_new_lengthv");

// GLIBCXX_3.4.11 is the version of every release since GCC 4.4; 3.4.30 differs in noexcept only.
extern "C" void older_wait(std::condition_variable*, std::unique_lock<std::mutex>*);
asm(".symver older_wait, _ZNSt18condition_variable4waitERSt11unique_lockISt5mutexE@GLIBCXX_3.4.11");
// Copy constructor and destructor of exception_ptr, which the headers have inline since GCC 11.
extern "C" void older_copy(void*, const void*);
extern "C" void older_destroy(void*);
asm(".symver older_copy, _ZNSt15__exception_ptr13exception_ptrC1ERKS0_@CXXABI_1.3.3");
asm(".symver older_destroy, _ZNSt15__exception_ptr13exception_ptrD1Ev@CXXABI_1.3.3");

namespace std {

void condition_variable::wait(unique_lock<mutex>& lock) noexcept { older_wait(this, &lock); }

namespace __exception_ptr {

// The copy stands for the reference that is counted, so it is not destroyed.
void exception_ptr::_M_addref() noexcept {
    alignas(exception_ptr) unsigned char copy[sizeof(exception_ptr)];
    older_copy(copy, this);
}

// The destructor of the older releases gives the reference back; the headers' inline one calls this.
void exception_ptr::_M_release() noexcept {
    older_destroy(this);
    _M_exception_object = nullptr;
}

}  // namespace __exception_ptr

void __throw_bad_array_new_length() { throw bad_array_new_length(); }

}  // namespace std
