// CHOLMOD's supernodal Cholesky, its own choice among its orderings; analysis and work space kept.
#include "serve.hpp"
#include <cholmod.h>
#include <cstring>

int main() {
    Problem p;
    if (!begin(p)) return 2;
    cholmod_common common;
    cholmod_start(&common);
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.print = 0;

    cholmod_sparse a = {};
    a.nrow = a.ncol = p.n, a.nzmax = p.entries, a.p = p.column.data(), a.i = p.row.data(), a.x = p.values.data();
    a.stype = -1, a.itype = CHOLMOD_INT, a.xtype = CHOLMOD_REAL, a.dtype = CHOLMOD_DOUBLE, a.sorted = a.packed = 1;
    cholmod_dense b = {};
    b.nrow = b.nzmax = b.d = p.n, b.ncol = 1, b.x = p.b.data(), b.xtype = CHOLMOD_REAL, b.dtype = CHOLMOD_DOUBLE;

    cholmod_factor *factor = cholmod_analyze(&a, &common);
    cholmod_dense *x = nullptr, *y = nullptr, *e = nullptr;
    while (next(p)) {
        const Stopwatch watch;
        cholmod_factorize(&a, factor, &common);
        const bool solved = common.status == CHOLMOD_OK &&
                            cholmod_solve2(CHOLMOD_A, factor, &b, nullptr, &x, nullptr, &y, &e, &common);
        const double seconds = solved ? watch.seconds() : -1.0;
        if (solved) std::memcpy(p.x.data(), x->x, sizeof(double) * p.n);
        answer(p, seconds, 0, common.memory_usage + p.entries * 12.0 + p.n * (4.0 + 8));
    }
    cholmod_free_dense(&x, &common), cholmod_free_dense(&y, &common), cholmod_free_dense(&e, &common);
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
}
