// What a reader says of bad input.
#pragma once

#include "preprocess/model_format/error.h"

#include <catch2/catch.hpp>

#include <string>

namespace splice::test {

/// The message of the InputError that `action` throws; fails the test if it throws none.
template <class Action>
std::string input_error(Action action) {
    try {
        action();
    } catch (const InputError& e) {
        return e.what();
    }
    FAIL("no InputError was thrown");
    return {};
}

}  // namespace splice::test
