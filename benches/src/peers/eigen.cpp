// Eigen: `ldlt` (SimplicialLDLT with AMD, pattern analysed once, lower triangle) or `cg TOLERANCE` (ConjugateGradient with
// the diagonal preconditioner on the full matrix, from zero).
#include "serve.hpp"
#include <Eigen/Sparse>
#include <cstdlib>
#include <cstring>

template <class Matrix> Matrix matrix(const Problem &p) {
    return Eigen::Map<const Matrix>(p.n, p.n, p.entries, p.column.data(), p.row.data(), p.values.data());
}

static const double ENTRY = sizeof(double) + sizeof(std::int32_t);

static void ldlt(Problem &p) {
    using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, std::int32_t>;
    Matrix a = matrix<Matrix>(p);
    Eigen::SimplicialLDLT<Matrix, Eigen::Lower, Eigen::AMDOrdering<std::int32_t>> solver;
    solver.analyzePattern(a);
    while (next(p)) {
        std::copy(p.values.begin(), p.values.end(), a.valuePtr());
        const Eigen::Map<const Eigen::VectorXd> b(p.b.data(), p.n);
        const Stopwatch watch;
        solver.factorize(a);
        Eigen::Map<Eigen::VectorXd>(p.x.data(), p.n) = solver.solve(b);
        const double seconds = solver.info() == Eigen::Success ? watch.seconds() : -1.0;
        // The factor, A and its permuted copy; diagonal, permutations, tree and counts, right side and solution.
        const double factor = solver.matrixL().nestedExpression().nonZeros();
        answer(p, seconds, 0, ENTRY * (factor + 2.0 * p.entries) + p.n * (3.0 * 8 + 5 * 4));
    }
}

static void cg(Problem &p, double tolerance) {
    using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor, std::int32_t>;
    Matrix a = matrix<Matrix>(p);
    Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper> solver;
    solver.setTolerance(tolerance).setMaxIterations(100000);
    while (next(p)) {
        std::copy(p.values.begin(), p.values.end(), a.valuePtr());
        const Eigen::Map<const Eigen::VectorXd> b(p.b.data(), p.n);
        const Stopwatch watch;
        solver.compute(a);
        Eigen::Map<Eigen::VectorXd>(p.x.data(), p.n) = solver.solve(b);
        const double seconds = watch.seconds();
        // A; the inverse diagonal, right side, x, r, p, Ap, z.
        answer(p, seconds, solver.iterations(), ENTRY * p.entries + p.n * (4.0 + 7 * 8));
    }
}

int main(int count, char **arguments) {
    Problem p;
    if (count < 2 || !begin(p)) return 2;
    if (std::strcmp(arguments[1], "ldlt") == 0) ldlt(p);
    else if (count == 3) cg(p, std::atof(arguments[2]));
    else return 2;
}
