// SPDX-License-Identifier: Apache-2.0
#include <CLI/Error.hpp>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "host/base/error.h"
#include "host/base/interrupt.h"
#include "present/program.h"

namespace {

// 128 + SIGINT, as shells count; SIGTERM ends with the same.
constexpr int kInterrupted = 130;

int fail(int code, const std::string& message) {
    std::fprintf(stderr, "kilolux: %s\n", message.c_str());
    return code;
}

// The exit code for what was thrown, and its line on stderr.
int fail(const std::exception_ptr& failure) {
    if (kilolux::interrupt_requested()) return fail(kInterrupted, kilolux::Interrupted().what());
    try {
        std::rethrow_exception(failure);
    } catch (const kilolux::UsageError& error) {
        return fail(2, error.what());
    } catch (const CLI::ParseError& error) {
        return fail(2, error.what());
    } catch (const kilolux::ComparisonFailed& error) {
        return fail(3, error.what());
    } catch (const std::bad_alloc&) {
        return fail(1, "out of memory");
    } catch (const std::exception& error) {
        return fail(1, error.what());
    }
}

}  // namespace

int main(int argc, char** argv) {
    kilolux::catch_signals();
    try {
        kilolux::Program program;
        program.run(std::vector<std::string>(argv + 1, argv + argc));
        if (std::fflush(stdout) != 0) return fail(1, "standard output: cannot write");
        return 0;
    } catch (...) {
        return fail(std::current_exception());
    }
}
