// SPDX-License-Identifier: Apache-2.0
#include "present/exit_code.h"

#include <signal.h>

#include <CLI/Error.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>

#include "host/base/error.h"
#include "host/base/system/interrupt.h"

namespace kilolux {
namespace {

// 128 and the signal's number, as shells count.
int interrupted_code() {
    const int number = ending_signal();
    return 128 + (number != 0 ? number : SIGINT);
}

int fail(int code, const char* message) {
    std::fprintf(stderr, "kilolux: %s\n", message);
    return code;
}

int fail(const std::exception_ptr& failure) {
    if (ending_signal() != 0) return fail(interrupted_code(), Interrupted().what());
    try {
        std::rethrow_exception(failure);
    } catch (const UsageError& error) {
        return fail(2, error.what());
    } catch (const CLI::ParseError& error) {
        return fail(2, error.what());
    } catch (const Interrupted& error) {
        return fail(interrupted_code(), error.what());
    } catch (const ComparisonFailed& error) {
        return fail(3, error.what());
    } catch (const std::bad_alloc&) {
        return fail(1, "out of memory");
    } catch (const std::filesystem::filesystem_error& error) {
        return fail(1, (error.path1().string() + ": " + error.code().message()).c_str());
    } catch (const std::exception& error) {
        return fail(1, error.what());
    } catch (...) {
        return fail(1, "internal error: an exception of unknown type");
    }
}

}  // namespace

int exit_code_of(const std::function<void()>& work) {
    try {
        work();
        return 0;
    } catch (...) {
        return fail(std::current_exception());
    }
}

void end_on_uncaught_exceptions() {
    std::set_terminate([] {
        const std::exception_ptr failure = std::current_exception();
        if (!failure) std::abort();
        std::_Exit(fail(failure));
    });
}

}  // namespace kilolux
