// The pipe to a solver in C++. In: n, entries (int64), column starts and rows (int32, compressed columns); then for each
// system the entries and the right side. Out, for each system: seconds (negative: failed), iterations, bytes; then x.
#pragma once
#include <cstdint>
#include <cstdio>
#include <ctime>
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

// The thread's own time: what others do on the machine meanwhile is not counted.
class Stopwatch {
    static double now() {
        timespec t;
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
        return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
    }
    double began = now();

  public:
    double seconds() const { return now() - began; }
};
