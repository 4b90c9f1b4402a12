// How long stages tell the outside how far they are. Called from the thread that runs the stage, monotone in
// `fraction`, never more than some hundred times a stage; an empty function is allowed everywhere.
#pragma once

#include <functional>
#include <string_view>

namespace splice {

using Progress = std::function<void(std::string_view stage, double fraction)>;

}  // namespace splice
