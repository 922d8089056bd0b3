// Integrates a system that `concio system` printed with SUNDIALS CVODE: BDF, analytic sparse Jacobian, KLU.
// docs/system.md describes the input, docs/theory.md the equations (1) to (6); nothing here knows of walls, so that
// geometry, assembly and integration are checked apart from each other.
//
//   cvode_shear SYSTEM.json RTOL ATOL INTERVAL [HISTORY.bin]
//
// Prints one line of JSON. HISTORY.bin gets the displacements of all unknowns at INTERVAL, 2 INTERVAL, … (64-bit floats,
// row by row). Work and mean square force of the top are summed over the solver's own steps, not over the samples, which
// stick-slip at some kilohertz would fall between.
//
// Build (Debian: apt-get install g++ libsundials-dev libsuitesparse-dev nlohmann-json3-dev):
//   g++ -O3 -march=native -std=c++17 cvode_shear.cpp -o cvode_shear -I/usr/include/suitesparse
//       -lsundials_cvode -lsundials_sunlinsolklu -lsundials_sunmatrixsparse -lsundials_nvecserial -lklu
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_version.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_sparse.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

namespace {

using nlohmann::json;

// Support sides of a joint; indices of unknowns are not negative.
constexpr int kBase = -1;
constexpr int kTop = -2;

struct Law {
    double excess = 0, dynamic = 0, slip_velocity = 1, steep = 0, alpha = 0;

    // μ(v) and its slope, equation (6).
    void at(double v, double &mu, double &slope) const {
        const double speed = std::fabs(v), z = steep * speed;
        const double decay = excess * std::exp(-speed / slip_velocity), level = decay + dynamic;
        const double angle = M_2_PI * std::atan(z);
        mu = std::copysign(angle * level + alpha * speed * speed, v);
        slope = M_2_PI * steep / (1 + z * z) * level - angle * decay / slip_velocity + 2 * alpha * speed;
    }
};

struct Joint {
    int a = 0, b = 0;
    bool one_sided = false, rubs = false;
    double stiffness = 0, damping = 0, normal_a = 0, normal_b = 0;
    Law law;
    // Where the joint stands in the Jacobian: rows of a and b, columns z_a, v_a, z_b, v_b.
    sunindextype in_a[4] = {0, 0, 0, 0}, in_b[4] = {0, 0, 0, 0};
};

struct Record {
    double interval = 0;
    std::vector<double> acceleration;

    double at(double t) const {
        if (acceleration.empty()) return 0;
        const double place = t / interval;
        const auto k = static_cast<size_t>(place);
        if (k + 1 >= acceleration.size()) return acceleration.back();
        const double part = place - static_cast<double>(k);
        return (1 - part) * acceleration[k] + part * acceleration[k + 1];
    }
};

struct Sine {
    double amplitude = 0, omega = 0, ramp = 0;

    void at(double t, double &u, double &v) const {
        const bool rising = t < ramp;
        const double factor = rising ? t / ramp : 1, rate = rising ? 1 / ramp : 0;
        u = amplitude * factor * std::sin(omega * t);
        v = amplitude * (factor * omega * std::cos(omega * t) + rate * std::sin(omega * t));
    }
};

struct System {
    std::vector<double> mass;
    std::vector<Joint> joints;
    Record base;
    Sine top;
    double duration = 0;
    // Compressed columns of the Jacobian, and where the ones of ż = v stand.
    std::vector<sunindextype> start, row, ones;
    long evaluations = 0, jacobians = 0;

    // The unknowns are interleaved: z_i at 2i, v_i at 2i + 1.
    void relative(const Joint &j, const double *y, double u, double v, double &d, double &w) const {
        d = y[2 * j.a] - (j.b >= 0 ? y[2 * j.b] : j.b == kTop ? u : 0);
        w = y[2 * j.a + 1] - (j.b >= 0 ? y[2 * j.b + 1] : j.b == kTop ? v : 0);
    }
};

double elastic(const Joint &j, double d) { return j.one_sided && d <= 0 ? 0 : j.stiffness; }

int rates(realtype t, N_Vector state, N_Vector rate, void *data) {
    auto &s = *static_cast<System *>(data);
    s.evaluations++;
    const double *y = N_VGetArrayPointer(state);
    double *f = N_VGetArrayPointer(rate), u, v;
    s.top.at(t, u, v);
    for (size_t i = 0; i < s.mass.size(); i++) f[2 * i] = y[2 * i + 1], f[2 * i + 1] = 0;
    for (const Joint &j : s.joints) {
        double d, w, mu = 0, slope;
        s.relative(j, y, u, v, d, w);
        if (j.rubs) j.law.at(w, mu, slope);
        const double smooth = elastic(j, d) * d + j.damping * w;
        f[2 * j.a + 1] -= smooth + j.normal_a * mu;
        if (j.b >= 0) f[2 * j.b + 1] += smooth + j.normal_b * mu;
    }
    const double ground = s.base.at(t);
    for (size_t i = 0; i < s.mass.size(); i++) f[2 * i + 1] = f[2 * i + 1] / s.mass[i] - ground;
    return 0;
}

int jacobian(realtype t, N_Vector state, N_Vector, SUNMatrix matrix, void *data, N_Vector, N_Vector, N_Vector) {
    auto &s = *static_cast<System *>(data);
    s.jacobians++;
    const double *y = N_VGetArrayPointer(state);
    double *entry = SUNSparseMatrix_Data(matrix), u, v;
    s.top.at(t, u, v);
    std::copy(s.start.begin(), s.start.end(), SUNSparseMatrix_IndexPointers(matrix));
    std::copy(s.row.begin(), s.row.end(), SUNSparseMatrix_IndexValues(matrix));
    std::fill_n(entry, s.row.size(), 0.0);
    for (auto at : s.ones) entry[at] = 1;
    for (const Joint &j : s.joints) {
        double d, w, mu, slope = 0;
        s.relative(j, y, u, v, d, w);
        if (j.rubs) j.law.at(w, mu, slope);
        const double k = elastic(j, d), a = j.damping + j.normal_a * slope, b = j.damping + j.normal_b * slope;
        const double in_a = 1 / s.mass[j.a];
        entry[j.in_a[0]] -= k * in_a;
        entry[j.in_a[1]] -= a * in_a;
        if (j.b < 0) continue;
        const double in_b = 1 / s.mass[j.b];
        entry[j.in_a[2]] += k * in_a;
        entry[j.in_a[3]] += a * in_a;
        entry[j.in_b[0]] += k * in_b;
        entry[j.in_b[1]] += b * in_b;
        entry[j.in_b[2]] -= k * in_b;
        entry[j.in_b[3]] -= b * in_b;
    }
    return 0;
}

void lay_pattern(System &s) {
    const auto n = static_cast<int>(s.mass.size());
    std::vector<std::set<sunindextype>> column(2 * n);
    for (int i = 0; i < n; i++) column[2 * i] = {2 * i, 2 * i + 1}, column[2 * i + 1] = {2 * i, 2 * i + 1};
    for (const Joint &j : s.joints) {
        if (j.b < 0) continue;
        for (int part : {0, 1}) {
            column[2 * j.a + part].insert(2 * j.b + 1);
            column[2 * j.b + part].insert(2 * j.a + 1);
        }
    }
    s.start.push_back(0);
    for (const auto &c : column) {
        s.row.insert(s.row.end(), c.begin(), c.end());
        s.start.push_back(static_cast<sunindextype>(s.row.size()));
    }
    auto place = [&](int r, int c) {
        const auto from = s.row.begin() + s.start[c], to = s.row.begin() + s.start[c + 1];
        return static_cast<sunindextype>(std::lower_bound(from, to, r) - s.row.begin());
    };
    for (int i = 0; i < n; i++) s.ones.push_back(place(2 * i, 2 * i + 1));
    for (Joint &j : s.joints) {
        const int b = j.b >= 0 ? j.b : j.a;
        const int columns[4] = {2 * j.a, 2 * j.a + 1, 2 * b, 2 * b + 1};
        for (int k = 0; k < 4; k++) j.in_a[k] = place(2 * j.a + 1, columns[k]), j.in_b[k] = place(2 * b + 1, columns[k]);
    }
}

Joint joint(const json &j) {
    Joint made;
    made.a = j.at("a");
    made.b = j.at("b").is_number() ? j.at("b").get<int>() : j.at("b") == "base" ? kBase : kTop;
    made.one_sided = j.at("law") == "no-tension";
    made.stiffness = j.at("stiffness");
    made.damping = j.at("damping");
    if (const json &f = j.at("friction"); !f.is_null()) {
        made.rubs = true;
        made.normal_a = j.at("normal_force").at(0);
        made.normal_b = j.at("normal_force").at(1);
        const double fixed = f.at("static"), dynamic = f.at("dynamic"), slip = f.at("slip_velocity");
        made.law = {fixed - dynamic, dynamic, slip, f.at("beta").get<double>() / slip, f.at("alpha")};
    }
    return made;
}

System read(const char *path) {
    const json in = json::parse(std::ifstream(path));
    System s;
    s.duration = in.at("duration");
    s.mass = in.at("mass").get<std::vector<double>>();
    for (const json &j : in.at("joints")) s.joints.push_back(joint(j));
    if (const json &base = in.at("base"); !base.is_null()) {
        if (base.contains("sine")) throw std::runtime_error("a sine of the base is not read here");
        s.base = {base.at("dt"), base.at("acceleration").get<std::vector<double>>()};
    }
    if (const json &top = in.at("top"); !top.is_null()) {
        const json &sine = top.at("sine");
        s.top = {sine.at("amplitude"), 2 * M_PI * sine.at("frequency").get<double>(), sine.at("ramp")};
    }
    lay_pattern(s);
    return s;
}

// Force of the top beam on the wall, and its velocity.
void top_force(const System &s, const double *y, double t, double &force, double &velocity) {
    double u;
    s.top.at(t, u, velocity);
    force = 0;
    for (const Joint &j : s.joints) {
        if (j.b != kTop) continue;
        double d, w, mu = 0, slope;
        s.relative(j, y, u, velocity, d, w);
        if (j.rubs) j.law.at(w, mu, slope);
        force -= j.stiffness * d + j.damping * w + j.normal_a * mu;
    }
}

}  // namespace

int main(int argc, char **argv) try {
    if (argc == 2 && std::string(argv[1]) == "--version") {
        std::printf("CVODE of SUNDIALS %s with KLU\n", SUNDIALS_VERSION);
        return 0;
    }
    if (argc < 5) {
        std::fprintf(stderr, "usage: cvode_shear SYSTEM.json RTOL ATOL INTERVAL [HISTORY.bin]\n");
        return 2;
    }
    System s = read(argv[1]);
    const double rtol = std::atof(argv[2]), atol = std::atof(argv[3]), interval = std::atof(argv[4]);
    const double duration = s.duration;
    const auto unknowns = static_cast<sunindextype>(2 * s.mass.size());

    SUNContext context;
    SUNContext_Create(nullptr, &context);
    N_Vector y = N_VNew_Serial(unknowns, context), at_sample = N_VNew_Serial(unknowns, context);
    N_VConst(0, y);
    void *cvode = CVodeCreate(CV_BDF, context);
    CVodeInit(cvode, rates, 0, y);
    CVodeSStolerances(cvode, rtol, atol);
    CVodeSetUserData(cvode, &s);
    CVodeSetMaxNumSteps(cvode, -1);
    CVodeSetStopTime(cvode, duration);
    // Unresolved, a record at rest for a while would be stepped over.
    if (s.base.interval > 0) CVodeSetMaxStep(cvode, s.base.interval);
    SUNMatrix matrix = SUNSparseMatrix(unknowns, unknowns, static_cast<sunindextype>(s.row.size()), CSC_MAT, context);
    CVodeSetLinearSolver(cvode, SUNLinSol_KLU(y, matrix, context), matrix);
    CVodeSetJacFn(cvode, jacobian);

    std::vector<double> history;
    const auto samples = std::lround(std::floor(duration / interval * (1 + 1e-12) + 1e-9));
    double t = 0, before = 0, force, velocity, peak = 0, slip = 0, work = 0, largest = 0, square = 0, slipped = 0;
    double last_force, last_velocity;
    top_force(s, N_VGetArrayPointer(y), 0, last_force, last_velocity);
    const auto begin = std::chrono::steady_clock::now();
    for (long sample = 1; t < duration;) {
        if (CVode(cvode, duration, y, &t, CV_ONE_STEP) < 0) {
            std::fprintf(stderr, "CVODE stopped at t = %g s\n", t);
            return 1;
        }
        const double *now = N_VGetArrayPointer(y);
        top_force(s, now, t, force, velocity);
        work += 0.5 * (t - before) * (force * velocity + last_force * last_velocity);
        square += 0.5 * (t - before) * (force * force + last_force * last_force);
        largest = std::max(largest, std::fabs(force));
        for (size_t i = 0; i < s.mass.size(); i++) peak = std::max(peak, std::fabs(now[2 * i]));
        before = t, last_force = force, last_velocity = velocity;
        for (; sample <= samples && sample * interval <= t + 1e-9 * interval; sample++) {
            CVodeGetDky(cvode, std::min(sample * interval, t), 0, at_sample);
            const double *then = N_VGetArrayPointer(at_sample);
            double u, v, d, w;
            s.top.at(sample * interval, u, v);
            for (const Joint &j : s.joints) {
                s.relative(j, then, u, v, d, w);
                if (!j.one_sided) slip = std::max(slip, std::fabs(w));
                // At the samples: summed over the steps it would cost time that the others do not spend.
                if (j.rubs && std::fabs(w) > j.law.slip_velocity) slipped += interval * std::fabs(w);
            }
            for (size_t i = 0; i < s.mass.size(); i++) history.push_back(then[2 * i]);
        }
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    long steps, factorisations;
    CVodeGetNumSteps(cvode, &steps);
    CVodeGetNumLinSolvSetups(cvode, &factorisations);
    const json result = {
        {"steps", steps},
        {"rhs", s.evaluations},
        {"jacobians", s.jacobians},
        {"factorisations", factorisations},
        {"solve_seconds", seconds},
        {"peak_relative_displacement", peak},
        {"peak_slip_velocity", slip},
        {"slip", slipped},
        {"top_work", work},
        {"top_force_peak", largest},
        {"top_force_rms", std::sqrt(square / duration)},
    };
    std::printf("%s\n", result.dump().c_str());
    if (argc > 5) {
        std::ofstream file(argv[5], std::ios::binary);
        file.write(reinterpret_cast<const char *>(history.data()), static_cast<std::streamsize>(history.size() * sizeof(double)));
    }
    return 0;
} catch (const std::exception &error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
}
