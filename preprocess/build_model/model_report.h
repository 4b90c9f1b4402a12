// What splice-info prints of a model, section by section.
#pragma once

#include "preprocess/model_format/model.h"

#include <string>

namespace splice {

std::string model_report_text(const ModelFile& file, const std::string& name);
std::string model_report_json(const ModelFile& file, const std::string& name);

}  // namespace splice
