// Misuse of the render graph.
#pragma once

#include "preprocess/model_format/error.h"

namespace splice::graph {

/// A declaration that cannot be rendered: what() names the pass, the resource and the fix. A defect of the calling
/// code, never of user input.
class GraphError : public Error {
  public:
    using Error::Error;
};

}  // namespace splice::graph
