// Garland's SMF as his QSlim reads it: `begin` opens a block with its own vertex numbering and transform, `end` closes
// it; transforms multiply from the right, as in OpenGL, so the last one named acts first; indices are 1-based within
// the block, negative ones count back from the newest vertex; `bind` says what the c, n and r that follow belong to.
#include "preprocess/mesh/mesh_formats.h"
#include "preprocess/mesh/source_mesh_builder.h"
#include "preprocess/mesh/text_scanner.h"
#include "preprocess/model_format/error.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace splice {
namespace {

enum class Binding { kNone, kVertex, kFace };

class SmfParser {
  public:
    SmfParser(std::string_view bytes, const std::string& name, const CompanionFiles& companions)
        : text_(bytes.starts_with("\xEF\xBB\xBF") ? bytes.substr(3) : bytes), name_(name), companions_(companions) {
        mesh_.polygon_begin.push_back(0);
    }

    SourceMesh parse() {
        while (!text_.at_end()) {
            const std::string_view command = text_.token_on_line();
            if (!command.empty() && command[0] != '#') statement(command);
            text_.line();
        }
        if (unknown_ > 0) {
            warn(mesh_,
                 std::to_string(unknown_) + " lines with unknown commands left out, the first is " + first_unknown_);
        }
        bind_attributes();
        return std::move(mesh_);
    }

  private:
    /// What `begin` saves and `end` restores.
    struct Block {
        Eigen::Matrix4d transform = Eigen::Matrix4d::Identity();
        double first_vertex = 0;
        double correction = 0;
    };

    void statement(std::string_view command) {
        if (command == "v") {
            mesh_.positions.push_back((block_.transform * numbers<3>("three coordinates").homogeneous()).hnormalized());
        } else if (command == "f" || command == "t") {
            face();
        } else if (command == "c") {
            const Vec3d c = numbers<3>("a colour");
            colours_.push_back(pack_colour(c[0], c[1], c[2]));
        } else if (command == "n") {
            const Eigen::Matrix3d linear = block_.transform.topLeftCorner<3, 3>();
            normals_.emplace_back((linear.inverse().transpose() * numbers<3>("a normal")).normalized().cast<float>());
        } else if (command == "r") {
            const Eigen::Vector2d r = numbers<2>("a texture coordinate");
            uvs_.emplace_back(Vec2f(static_cast<float>(r[0]), static_cast<float>(1 - r[1])));
        } else if (command == "bind") {
            bind();
        } else if (command == "tex") {
            texture();
        } else if (!transform(command) && !scope(command)) {
            if (unknown_++ == 0) first_unknown_ = "line " + std::to_string(text_.line_number());
        }
    }

    template <int N>
    Eigen::Matrix<double, N, 1> numbers(const char* expected) {
        Eigen::Matrix<double, N, 1> values;
        for (int k = 0; k < N; ++k) {
            if (!text_.number_on_line(values[k]))
                throw InputError(name_, text_.where(), std::string("expected ") + expected);
        }
        return values;
    }

    void face() {
        double index = 0;
        while (text_.number_on_line(index)) {
            const double newest = static_cast<double>(mesh_.positions.size());
            const double zero_based = index > 0   ? index - 1 + block_.first_vertex + block_.correction
                                      : index < 0 ? newest + index
                                                  : -1;
            mesh_.corner_position.push_back(to_index(zero_based));
        }
        mesh_.polygon_begin.push_back(mesh_.corner_position.size());
    }

    void bind() {
        const std::string_view attribute = text_.token_on_line();
        const std::string_view to = text_.token_on_line();
        const Binding binding = to == "vertex" ? Binding::kVertex : to == "face" ? Binding::kFace : Binding::kNone;
        if (attribute == "c") {
            colour_binding_ = binding;
        } else if (attribute == "n") {
            normal_binding_ = binding;
        } else if (attribute == "r") {
            uv_binding_ = binding;
        } else {
            throw InputError(name_, text_.where(), "expected \"bind c|n|r vertex|face|none\"");
        }
    }

    void texture() {
        const std::string_view file = trimmed(text_.rest_of_line());
        if (mesh_.materials.empty()) {
            add_image_material(std::string(file), companions_, mesh_);
        } else {
            warn(mesh_, "a second texture is left out: \"" + printable(file) + "\"");
        }
    }

    bool transform(std::string_view command) {
        Eigen::Affine3d step = Eigen::Affine3d::Identity();
        if (command == "trans") {
            step.translate(numbers<3>("three distances"));
        } else if (command == "scale") {
            step.scale(numbers<3>("three factors"));
        } else if (command == "rot") {
            const std::string_view axis = text_.token_on_line();
            const double radians = numbers<1>("an angle in degrees")[0] * std::numbers::pi / 180;
            if (axis != "x" && axis != "y" && axis != "z")
                throw InputError(name_, text_.where(), "expected an axis x, y or z");
            step.rotate(Eigen::AngleAxisd(radians, Vec3d::Unit(axis[0] - 'x')));
        } else if (command == "mmult" || command == "mload") {
            const auto m = numbers<16>("a 4 x 4 matrix");
            const Eigen::Matrix4d matrix = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(m.data());
            block_.transform = command == "mload" ? matrix : (block_.transform * matrix).eval();
            return true;
        } else {
            return false;
        }
        block_.transform = block_.transform * step.matrix();
        return true;
    }

    bool scope(std::string_view command) {
        if (command == "begin") {
            outer_.push_back(block_);
            block_.first_vertex = static_cast<double>(mesh_.positions.size());
            block_.correction = 0;
        } else if (command == "end") {
            if (outer_.empty()) throw InputError(name_, text_.where(), "\"end\" without \"begin\"");
            block_ = outer_.back();
            outer_.pop_back();
        } else if (command == "set") {
            if (text_.token_on_line() == "vertex_correction") block_.correction = numbers<1>("a number")[0];
        } else {
            return false;
        }
        return true;
    }

    void bind_attributes() {
        VertexAttributes vertex;
        if (colour_binding_ == Binding::kVertex) vertex.colours = std::move(colours_);
        if (normal_binding_ == Binding::kVertex) vertex.normals = std::move(normals_);
        if (uv_binding_ == Binding::kVertex) vertex.uvs = std::move(uvs_);
        expand_vertex_attributes(vertex, mesh_);
        if (colour_binding_ == Binding::kFace) mesh_.corner_colours = expand_polygon_values(colours_, kWhite, mesh_);
        if (normal_binding_ == Binding::kFace) {
            mesh_.corner_normals = expand_polygon_values<Vec3f>(normals_, Vec3f::Zero(), mesh_);
        }
        if (uv_binding_ == Binding::kFace) mesh_.corner_uvs = expand_polygon_values<Vec2f>(uvs_, Vec2f::Zero(), mesh_);
    }

    TextScanner text_;
    const std::string& name_;
    const CompanionFiles& companions_;
    SourceMesh mesh_;
    Block block_;
    std::vector<Block> outer_;
    std::vector<std::uint32_t> colours_;
    std::vector<Vec3f> normals_;
    std::vector<Vec2f> uvs_;
    Binding colour_binding_ = Binding::kNone, normal_binding_ = Binding::kNone, uv_binding_ = Binding::kNone;
    std::size_t unknown_ = 0;
    std::string first_unknown_;
};

}  // namespace

SourceMesh parse_smf(std::string_view bytes, const std::string& name, const CompanionFiles& companions) {
    return SmfParser(bytes, name, companions).parse();
}

}  // namespace splice
