// Geogram's parallel Delaunay tetrahedra of a file of points, timed; prints one JSON object.
//
// usage: geogram_delaunay POINTS THREADS
//
// POINTS holds x, y, z of one point after the other as float64, little endian. The seconds are those of
// building the triangulation from points in memory.

#include <geogram/basic/command_line.h>
#include <geogram/basic/command_line_args.h>
#include <geogram/basic/common.h>
#include <geogram/basic/environment.h>
#include <geogram/basic/logger.h>
#include <geogram/basic/process.h>
#include <geogram/delaunay/delaunay.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

int main(int count, char** words) {
    if (count < 3) {
        std::fprintf(stderr, "usage: geogram_delaunay POINTS THREADS\n");
        return 2;
    }
    std::vector<double> coordinates;
    std::ifstream file(words[1], std::ios::binary);
    double number;
    while (file.read(reinterpret_cast<char*>(&number), sizeof number)) coordinates.push_back(number);

    GEO::initialize(GEO::GEOGRAM_INSTALL_NONE);
    GEO::Logger::instance()->set_quiet(true);
    GEO::CmdLine::import_arg_group("standard");
    GEO::CmdLine::import_arg_group("algo");
    GEO::Process::set_max_threads(static_cast<GEO::index_t>(std::atoi(words[2])));

    GEO::Delaunay_var delaunay = GEO::Delaunay::create(3, "PDEL");
    const auto start = std::chrono::steady_clock::now();
    delaunay->set_vertices(static_cast<GEO::index_t>(coordinates.size() / 3), coordinates.data());
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    const std::string version = GEO::Environment::instance()->get_value("version");
    std::printf("{\"engine\": \"Geogram %s\", \"seconds\": %.6f, \"cells\": %zu}\n", version.c_str(),
                seconds.count(), static_cast<std::size_t>(delaunay->nb_cells()));
}
