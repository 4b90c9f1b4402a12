// What a model must satisfy beyond fitting its sections: every index in range, every range in order, every number
// finite. After it the engine may upload and follow indices without looking.
#pragma once

#include "preprocess/model_format/model.h"

#include <string>

namespace splice {

/// `base` is the first byte of the file that `view` points into, for the byte offsets in messages. Throws InputError.
void validate_model(const ModelView& view, const std::byte* base, const std::string& name);

}  // namespace splice
