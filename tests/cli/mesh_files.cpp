#include "tests/cli/mesh_files.h"

#include <cmath>
#include <fstream>

namespace splice::test {

void write_cube(const std::filesystem::path& path) {
    std::ofstream file(path);
    for (int i = 0; i < 8; ++i)
        file << "v " << (i & 1) << ' ' << (i >> 1 & 1) << ' ' << (i >> 2) << '\n';
    file << "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
}

void write_bumpy_torus(const std::filesystem::path& path, unsigned rings) {
    std::ofstream file(path);
    const unsigned around = 2 * rings;
    file << "OFF\n" << rings * around << ' ' << 2 * rings * around << " 0\n";
    for (unsigned i = 0; i < around; ++i) {
        for (unsigned j = 0; j < rings; ++j) {
            const double u = 2 * M_PI * i / around, v = 2 * M_PI * j / rings;
            const double bump = u < M_PI ? 0.03 * std::sin(40 * u) * std::sin(17 * v) : 0;
            const double minor = 0.3 + bump, reach = 1 + minor * std::cos(v);
            file << reach * std::cos(u) << ' ' << reach * std::sin(u) << ' ' << minor * std::sin(v) << '\n';
        }
    }
    for (unsigned i = 0; i < around; ++i) {
        for (unsigned j = 0; j < rings; ++j) {
            const unsigned a = i * rings + j, b = (i + 1) % around * rings + j;
            const unsigned c = (i + 1) % around * rings + (j + 1) % rings, d = i * rings + (j + 1) % rings;
            file << "3 " << a << ' ' << b << ' ' << c << "\n3 " << a << ' ' << c << ' ' << d << '\n';
        }
    }
}

}  // namespace splice::test
