// The pipe to a solver in C++. In: n, entries (int64), column starts and rows (int32, compressed columns); then for each
// system the entries and the right side. Out, for each system: seconds (negative: failed), iterations, bytes; then x.
#pragma once
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <vector>

struct Problem {
    std::int64_t n = 0, entries = 0;
    std::vector<std::int32_t> column, row;
    std::vector<double> values, b, x;
};

template <class T> bool get(T *to, std::size_t count) { return std::fread(to, sizeof(T), count, stdin) == count; }

inline bool begin(Problem &p) {
    if (!get(&p.n, 1) || !get(&p.entries, 1)) return false;
    p.column.resize(p.n + 1), p.row.resize(p.entries), p.values.resize(p.entries), p.b.resize(p.n), p.x.resize(p.n);
    return get(p.column.data(), p.column.size()) && get(p.row.data(), p.row.size());
}

inline bool next(Problem &p) { return get(p.values.data(), p.values.size()) && get(p.b.data(), p.b.size()); }

inline void answer(const Problem &p, double seconds, double iterations, double bytes) {
    const double head[3] = {seconds, iterations, bytes};
    std::fwrite(head, sizeof(double), 3, stdout);
    std::fwrite(p.x.data(), sizeof(double), p.x.size(), stdout);
    std::fflush(stdout);
}

class Stopwatch {
    std::chrono::steady_clock::time_point began = std::chrono::steady_clock::now();

  public:
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count(); }
};
