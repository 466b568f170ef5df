// Times CGAL's autorefinement with iterative snap rounding on a binary STL file, as one of the other programs of `union_speed.py`.
// usage: autorefine FILE.stl      prints {"seconds": , "triangles": , "done": }
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/autorefinement.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <vector>

using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
namespace PMP = CGAL::Polygon_mesh_processing;

int main(int, char** words) {
    std::ifstream file(words[1], std::ios::binary);
    std::vector<char> bytes((std::istreambuf_iterator<char>(file)), {});
    std::uint32_t count;
    std::memcpy(&count, &bytes[80], 4);
    std::vector<Point> points;
    std::vector<std::array<std::size_t, 3>> triangles;
    for (std::size_t t = 0; t < count; ++t) {
        float x[9];
        std::memcpy(x, &bytes[84 + 50 * t + 12], sizeof x);
        const std::size_t first = points.size();
        for (int corner = 0; corner < 3; ++corner) points.emplace_back(x[3 * corner], x[3 * corner + 1], x[3 * corner + 2]);
        triangles.push_back({first, first + 1, first + 2});
    }
    PMP::merge_duplicate_points_in_polygon_soup(points, triangles);
    const auto begin = std::chrono::steady_clock::now();
    const bool done = PMP::autorefine_triangle_soup(points, triangles, CGAL::parameters::apply_iterative_snap_rounding(true));
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    std::printf("{\"seconds\": %.6f, \"triangles\": %zu, \"done\": %s}\n", seconds.count(), triangles.size(), done ? "true" : "false");
}
