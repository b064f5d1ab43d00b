// CGAL's Delaunay tetrahedra of a file of points, timed; prints one JSON object.
//
// usage: cgal_delaunay POINTS serial|parallel THREADS [ALPHA]
//
// POINTS holds x, y, z of one point after the other as float64, little endian. The seconds are those of
// building the triangulation from points in memory. With ALPHA the cells whose circumradius is at most
// that are counted too, which is not timed.

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_cell_base_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/version.h>
#include <tbb/global_control.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
template <class Concurrency>
using Triangulation = CGAL::Delaunay_triangulation_3<
    Kernel, CGAL::Triangulation_data_structure_3<CGAL::Triangulation_vertex_base_3<Kernel>,
                                                 CGAL::Delaunay_triangulation_cell_base_3<Kernel>, Concurrency>>;
using Clock = std::chrono::steady_clock;

static std::vector<Point> read_points(const char* path) {
    std::ifstream file(path, std::ios::binary);
    std::vector<Point> points;
    double at[3];
    while (file.read(reinterpret_cast<char*>(at), sizeof at)) points.emplace_back(at[0], at[1], at[2]);
    return points;
}

template <class T>
static void report(const T& triangulation, Clock::time_point start, double alpha) {
    const std::chrono::duration<double> seconds = Clock::now() - start;
    std::printf("{\"engine\": \"CGAL %s\", \"seconds\": %.6f, \"cells\": %zu", CGAL_VERSION_STR, seconds.count(),
                static_cast<std::size_t>(triangulation.number_of_finite_cells()));
    if (alpha > 0) {
        std::size_t kept = 0;
        for (auto cell : triangulation.finite_cell_handles())
            kept += CGAL::squared_radius(cell->vertex(0)->point(), cell->vertex(1)->point(), cell->vertex(2)->point(),
                                         cell->vertex(3)->point()) <= alpha * alpha;
        std::printf(", \"alpha_cells\": %zu", kept);
    }
    std::printf("}\n");
}

int main(int count, char** words) {
    if (count < 4) {
        std::fprintf(stderr, "usage: cgal_delaunay POINTS serial|parallel THREADS [ALPHA]\n");
        return 2;
    }
    const std::vector<Point> points = read_points(words[1]);
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, std::atoi(words[3]));
    const double alpha = count > 4 ? std::atof(words[4]) : 0;
    const auto start = Clock::now();
    if (std::strcmp(words[2], "serial") == 0) {
        report(Triangulation<CGAL::Sequential_tag>(points.begin(), points.end()), start, alpha);
    } else {
        // The grid of locks is a part of CGAL's parallel insertion, so its making is timed too.
        Triangulation<CGAL::Parallel_tag>::Lock_data_structure locks(CGAL::bbox_3(points.begin(), points.end()), 50);
        report(Triangulation<CGAL::Parallel_tag>(points.begin(), points.end(), &locks), start, alpha);
    }
}
