#include "engine/capture/prepare_scene.h"
#include "preprocess/mesh/shapes.h"
#include "preprocess/model_format/error.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <sstream>

namespace splice {

namespace {

struct Parameter {
    std::string_view name;
    std::uint32_t least, most, preset;
};

using Arguments = std::vector<std::uint32_t>;

struct Kind {
    std::string_view name;
    std::vector<Parameter> parameters;
    std::function<SourceMesh(const Arguments&)> make;
};

// Limits keep a mesh below some ten million triangles.
const std::vector<Kind>& kinds() {
    static const std::vector<Kind> all{
        {"cube", {{"cells", 1, 1000, 1}}, [](const Arguments& a) { return shapes::cube(a[0]); }},
        {"uv-sphere",
         {{"slices", 3, 4000, 64}, {"stacks", 2, 2000, 32}},
         [](const Arguments& a) { return shapes::uv_sphere(a[0], a[1]); }},
        {"ico-sphere", {{"frequency", 1, 700, 32}}, [](const Arguments& a) { return shapes::ico_sphere(a[0]); }},
        {"bumpy-sphere",
         {{"triangles", 20, 10'000'000, 80'000}},
         [](const Arguments& a) { return shapes::bumpy_sphere(a[0]); }},
        {"torus-knot",
         {{"p", 1, 20, 2}, {"q", 1, 20, 3}, {"segments", 3, 10'000, 600}, {"sides", 3, 500, 40}},
         [](const Arguments& a) { return shapes::torus_knot(a[0], a[1], a[2], a[3]); }},
        {"terrain",
         {{"cells", 1, 2000, 256}, {"seed", 0, 0xffffffffu, 1}},
         [](const Arguments& a) { return shapes::terrain(a[0], a[1]); }},
        {"checkerboard",
         {{"tiles", 1, 1024, 16}, {"cells", 1, 1000, 1}},
         [](const Arguments& a) { return shapes::checkerboard(a[0], a[1]); }},
        {"machined-part", {{"segments", 8, 4096, 96}}, [](const Arguments& a) { return shapes::machined_part(a[0]); }},
    };
    return all;
}

std::string format_number(double value) {
    std::ostringstream out;
    out << value;
    return out.str();
}

template <typename Range>
std::string names_of(const Range& range) {
    std::string list;
    for (const auto& each : range)
        list += (list.empty() ? "" : ", ") + std::string(each.name);
    return list;
}

}  // namespace

SourceMesh make_shape(const ShapeDescription& shape, const std::string& name, const std::string& path) {
    const auto kind = std::find_if(kinds().begin(), kinds().end(), [&](const Kind& k) { return k.name == shape.kind; });
    if (kind == kinds().end())
        throw InputError(name, path + "/kind", "expected one of " + names_of(kinds()) + ", got \"" + shape.kind + "\"");
    for (const auto& [parameter, value] : shape.parameters) {
        const bool known = std::any_of(kind->parameters.begin(), kind->parameters.end(),
                                       [&](const Parameter& p) { return p.name == parameter; });
        if (!known)
            throw InputError(name, path + "/" + parameter,
                             "unknown member, expected one of kind, " + names_of(kind->parameters));
    }
    Arguments arguments;
    for (const Parameter& parameter : kind->parameters) {
        const auto given = shape.parameters.find(std::string(parameter.name));
        if (given == shape.parameters.end()) {
            arguments.push_back(parameter.preset);
            continue;
        }
        const double value = given->second;
        if (value != std::floor(value) || value < parameter.least || value > parameter.most)
            throw InputError(name, path + "/" + std::string(parameter.name),
                             "expected a whole number from " + std::to_string(parameter.least) + " to " +
                                 std::to_string(parameter.most) + ", got " + format_number(value));
        arguments.push_back(static_cast<std::uint32_t>(value));
    }
    if (kind->name == "torus-knot" && std::gcd(arguments[0], arguments[1]) != 1)
        throw InputError(name, path,
                         "expected p and q without a common divisor, got " + std::to_string(arguments[0]) + " and " +
                             std::to_string(arguments[1]));
    return kind->make(arguments);
}

}  // namespace splice
