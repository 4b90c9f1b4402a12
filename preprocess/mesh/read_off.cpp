// Geomview's Object File Format, http://www.geomview.org/docs/html/OFF.html. White space separates everywhere, but a
// face's colour ends with its line; in practice each vertex has its line too, with more numbers on it than declared.
#include "preprocess/mesh/mesh_formats.h"
#include "preprocess/mesh/source_mesh_builder.h"
#include "preprocess/mesh/text_scanner.h"
#include "preprocess/model_format/error.h"

#include <array>
#include <cmath>

namespace splice {
namespace {

struct OffHeader {
    bool uv = false, colour = false, normal = false, homogeneous = false;
    std::size_t vertices = 0, faces = 0;
};

/// A scanner for which `#` starts a comment.
class OffText {
  public:
    OffText(std::string_view bytes, const std::string& name)
        : text_(bytes.starts_with("\xEF\xBB\xBF") ? bytes.substr(3) : bytes), name_(name) {}

    TextScanner& raw() { return text_; }

    void skip_to_data() {
        for (;;) {
            text_.skip_spaces();
            if (text_.at_end() || text_.peek() != '#') return;
            text_.line();
        }
    }
    double number(const char* expected) {
        skip_to_data();
        double value = 0;
        if (!text_.number(value)) fail(std::string("expected ") + expected);
        return value;
    }
    /// Numbers up to the end of the line, at most as many as fit; returns how many, and moves to the next line.
    template <std::size_t N>
    std::size_t numbers_to_line_end(std::array<double, N>& values) {
        std::size_t count = 0;
        while (count < N && text_.number_on_line(values[count]))
            ++count;
        text_.line();
        return count;
    }
    std::size_t lines_left() const {
        std::size_t lines = 0;
        TextScanner ahead(text_.rest());
        while (!ahead.at_end()) {
            ahead.skip_spaces();
            if (!ahead.at_end() && ahead.peek() != '#') ++lines;
            ahead.line();
        }
        return lines;
    }
    [[noreturn]] void fail(const std::string& problem) const {
        throw InputError(name_, text_.where(), text_.at_end() ? "file ends, " + problem : problem);
    }
    /// What began at `start` is at fault, however far it was read since.
    [[noreturn]] void fail_at(const TextScanner& start, const std::string& problem) const {
        throw InputError(name_, start.where(), problem);
    }

  private:
    TextScanner text_;
    const std::string& name_;
};

std::size_t read_count(OffText& text, const char* what) {
    const double value = text.number(what);
    // Every vertex and every face takes at least two characters.
    if (!(value >= 0) || value != std::floor(value) || value > static_cast<double>(text.raw().rest().size()) / 2 + 1) {
        text.fail(std::string("impossible ") + what);
    }
    return static_cast<std::size_t>(value);
}

OffHeader read_header(OffText& text) {
    OffHeader header;
    text.skip_to_data();
    const auto accept = [&](std::string_view keyword) {
        if (!text.raw().rest().starts_with(keyword)) return false;
        text.raw().skip(keyword.size());
        return true;
    };
    header.uv = accept("ST");
    header.colour = accept("C");
    header.normal = accept("N");
    header.homogeneous = accept("4");
    const bool n_dimensional = accept("n");
    if (accept("OFF")) {  // the counts may follow without a blank
        text.raw().skip_blanks();
        if (accept("BINARY")) text.fail("binary OFF is not supported, expected ascii OFF");
    } else {
        text.fail("expected an OFF header");
    }
    if (n_dimensional && text.number("the dimension of space") != 3)
        text.fail("only three-dimensional OFF is supported");
    header.vertices = read_count(text, "number of vertices");
    header.faces = read_count(text, "number of faces");
    double edges = 0;
    text.raw().number_on_line(edges);  // never used, and some writers leave it out
    return header;
}

/// A colour of 3 or 4 components, whole numbers of 0..255 or fractions of 0..1; one number is an index into a colour
/// map that the file does not have.
std::uint32_t to_colour(const std::array<double, 4>& c, std::size_t components) {
    if (components < 3) return kWhite;
    const double largest = std::max({c[0], c[1], c[2]});
    const double scale = largest > 1 ? 1.0 / 255 : 1.0;
    return pack_colour(c[0] * scale, c[1] * scale, c[2] * scale);
}

void read_vertices(OffText& text, const OffHeader& header, SourceMesh& mesh, VertexAttributes& attributes) {
    // With fewer lines than vertices and faces the file is a free stream of numbers, otherwise what exceeds the
    // declared numbers on a vertex's line is decoration.
    const bool one_per_line = text.lines_left() >= header.vertices + header.faces;
    for (std::size_t v = 0; v < header.vertices; ++v) {
        Vec3d position;
        for (int k = 0; k < 3; ++k)
            position[k] = text.number("a vertex coordinate");
        if (header.homogeneous) position /= text.number("a vertex coordinate");
        mesh.positions.push_back(position);
        if (header.normal) {
            Vec3d normal;
            for (int k = 0; k < 3; ++k)
                normal[k] = text.number("a vertex normal");
            attributes.normals.push_back(normal.cast<float>());
        }
        if (header.colour) {
            std::array<double, 4> colour{};
            std::size_t components = 0;
            for (; components < 3; ++components)
                colour[components] = text.number("a vertex colour");
            // RGBA is the rule; a line that ends here, or goes on with texture coordinates only, has RGB.
            TextScanner ahead(text.raw().rest());
            double ignored = 0;
            std::size_t more = 0;
            while (more < 4 && ahead.number_on_line(ignored))
                ++more;
            if (more == (header.uv ? 3u : 1u) || !one_per_line) text.number("a vertex colour");
            attributes.colours.push_back(to_colour(colour, components));
        }
        if (header.uv) {
            const double u = text.number("a texture coordinate");
            const double down = 1 - text.number("a texture coordinate");
            attributes.uvs.push_back(Vec2d(u, down).cast<float>());
        }
        if (one_per_line) text.raw().line();
    }
}

}  // namespace

SourceMesh parse_off(std::string_view bytes, const std::string& name) {
    OffText text(bytes, name);
    const OffHeader header = read_header(text);
    SourceMesh mesh;
    VertexAttributes attributes;
    read_vertices(text, header, mesh, attributes);

    mesh.polygon_begin.push_back(0);
    std::vector<std::uint32_t> face_colours;
    bool any_face_colour = false;
    for (std::size_t f = 0; f < header.faces; ++f) {
        text.skip_to_data();
        const TextScanner start = text.raw();
        const double corners = text.number("the number of corners of a face");
        // Every corner takes at least a blank and a digit.
        const std::size_t left = text.raw().rest().size();
        if (!(corners >= 0) || corners != std::floor(corners) || corners > static_cast<double>(left) / 2)
            text.fail_at(start, "impossible number of corners " + printable(start.rest_of_line()));
        for (auto corner = static_cast<std::size_t>(corners); corner > 0; --corner) {
            text.skip_to_data();
            if (text.raw().at_end())
                text.fail_at(start, "a face of " + std::to_string(static_cast<std::size_t>(corners)) +
                                        " corners, but the file ends after " +
                                        std::to_string(static_cast<std::size_t>(corners) - corner));
            mesh.corner_position.push_back(to_index(text.number("a vertex index")));
        }
        mesh.polygon_begin.push_back(mesh.corner_position.size());
        std::array<double, 4> colour{};
        const std::size_t components = text.numbers_to_line_end(colour);
        face_colours.push_back(to_colour(colour, components));
        any_face_colour |= components >= 3;
    }
    expand_vertex_attributes(attributes, mesh);
    if (any_face_colour && mesh.corner_colours.empty()) {
        mesh.corner_colours = expand_polygon_values(face_colours, kWhite, mesh);
    }
    return mesh;
}

}  // namespace splice
