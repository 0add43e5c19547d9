// A lattice that `sheetbench ... --export DIR` wrote, in C++17: explicit steps until it is at rest.
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iostream>
#include <sstream>
#include <valarray>
#include <vector>
using Field = std::valarray<double>;              // x, y, z of every mass
using Sum = std::vector<std::pair<int, double>>;  // some masses and their weights
struct V { double x = 0, y = 0, z = 0; };
struct Hold { Sum mean; int axis; double place; };
struct Spring { std::string kind; Sum a, b, q; double rest; std::array<double, 8> k; double largest; V free; };
Sum operator+(Sum a, Sum b) { a.insert(a.end(), b.begin(), b.end()); return a; }
V operator+(V a, V b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
V operator*(double s, V a) { return {s * a.x, s * a.y, s * a.z}; }
double dot(V a, V b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
V cross(V a, V b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
V take(const Field& x, int m) { return {x[3 * m], x[3 * m + 1], x[3 * m + 2]}; }
V of(const Field& x, const Sum& s) { V v; for (auto [m, w] : s) v = v + w * take(x, m); return v; }
void add(V f, int m, Field& g) { g[3 * m] += f.x, g[3 * m + 1] += f.y, g[3 * m + 2] += f.z; }
void rubber(const Spring& s, V a, V b, V q, double aa, double bb, V& by_a, V& by_b, V& by_q) {
  auto [c10, c01, c20, c30, v, limit, ka, kb] = s.k;
  double over = limit > 0 ? 1 / limit : 0, qq = dot(q, q), f1 = 0, pull = 0, theta = 1;
  double c11 = (dot(a, a) + qq / 12) / aa, c22 = (dot(b, b) + qq / 12) / bb, c12 = dot(a, b) / s.rest;
  double trace = c11 + c22, area = c11 * c22 - c12 * c12, step = 1, x = -v / (v + 4 * (c10 + c01)) * std::log(area);
  for (int n = 0; n < 50 && fabs(step) > 1e-15; n++, x -= step) {  // Newton's method for the thickness
    theta = std::exp(x);
    double i = trace + theta - 3, left = 1 - i * over;
    double f2 = c10 * over / (left * left) + 2 * c20 + 6 * c30 * i;
    f1 = c10 / left + 2 * c20 * i + 3 * c30 * i * i, pull = theta * (f1 + c01 * trace);
    step = (pull - c10 - 2 * c01 + v / 4 * (std::log(area) + x)) / (pull + theta * theta * f2 + v / 4);
  }
  double by_trace = f1 + c01 * theta, by_area = c01 - pull / area, both = -2 * by_area * c12;
  double pa = ka * (1 - sqrt(aa / (dot(a, a) + qq / 4))), on_a = 2 * s.rest * (by_trace + by_area * c22) / aa;
  double pb = kb * (1 - sqrt(bb / (dot(b, b) + qq / 4))), on_b = 2 * s.rest * (by_trace + by_area * c11) / bb;
  by_a = (on_a - pa) * a + both * b, by_b = (on_b - pb) * b + both * a;
  by_q = ((on_a + on_b) / 12 - (pa + pb) / 4) * q;
}
Field gradient(const std::vector<Spring>& springs, const Field& start, const Field& u) {  // see README.md
  Field g(u.size()), now = start + u;
  for (auto& s : springs) {
    auto [k1, k2, k3, k4, k5, k6, k7, k8] = s.k;
    V a = of(now, s.a), b = of(now, s.b), q = of(now, s.q), c = cross(a, b);
    V by_a, by_b, by_q;
    double aa = s.free.x, bb = s.free.y, cc = dot(c, c);
    double e1 = (dot(a, a) / aa - 1) / 2, e2 = (dot(b, b) / bb - 1) / 2, e3 = (dot(a, b) - s.free.z) / s.rest;
    double sides = sqrt(dot(a, a) * bb), sheared = s.rest * k1 * dot(a, b) / (sides * sides);  // of a face
    if (s.kind == "link") by_a = k1 * (1 - s.rest / sqrt(dot(a, a))) * a;
    if (s.kind == "area") c = k1 / 2 * (0.5 / s.rest - 1 / sqrt(cc)) * c, by_a = cross(b, c), by_b = cross(c, a);
    double t1 = k1 * e1, t2 = k2 * e2, t3 = k3 * e3;
    if (s.kind == "coupling") t1 = k1 * e2 + k2 * e3, t2 = k1 * e1 + k3 * e3, t3 = k2 * e1 + k3 * e2;
    if (s.kind == "strain" || s.kind == "coupling")
      by_a = t1 * s.rest / aa * a + t3 * b, by_b = t2 * s.rest / bb * b + t3 * a;
    if (s.kind == "rubber") rubber(s, a, b, q, aa, bb, by_a, by_b, by_q);
    if (s.kind == "face") by_b = sheared * a, by_a = sheared * (b + -dot(a, b) / dot(a, a) * a);
    for (auto [m, w] : s.a) add(w * by_a, m, g);
    for (auto [m, w] : s.b) add(w * by_b, m, g);
    for (auto [m, w] : s.q) add(w * by_q, m, g);
  }
  return g;
}
std::stringstream open(std::string path, std::string all = "", std::string part = "") {
  for (std::ifstream file(path); std::getline(file, part, ',');) all += part + " ";
  if (all.empty()) return std::stringstream();  // no such file
  return std::stringstream(all.substr(all.find('\n')));  // without the names of the columns
}
Sum mean(std::string masses, double weight = 1, Sum sum = {}) {  // of "4+5" half of each
  weight /= 1 + std::count(masses.begin(), masses.end(), '+');
  for (std::stringstream in(masses); in.good(); in.ignore()) in >> sum.emplace_back(0, weight).first;
  return sum;
}
int main(int count, char** words) {
  if (count != 2) return std::cerr << "usage: read_lattice DIR\n", 2;
  std::string at = words[1] + std::string("/"), kind, c[4];
  double x, y, z, rest, k1, k2, k3, moved = 1;
  std::vector<double> places; std::vector<Spring> springs; std::vector<Hold> holds;
  if (open(at + "followers.csv") >> kind) return std::cerr << "knows dead loads only\n", 2;
  if (open(at + "contacts.csv") >> kind) return std::cerr << "knows no obstacles\n", 2;
  for (auto in = open(at + "nodes.csv"); in >> kind >> c[0] >> c[1] >> c[2] >> x >> y >> z >> kind;)
    places.insert(places.end(), {x, y, z});
  Field start(places.data(), places.size()), u(start.size()), v = u, load = u, truth = u, before = u, mass = u;
  for (auto in = open(at + "links.csv"); in >> c[0] >> c[1] >> kind >> rest >> k1 >> x;)
    springs.push_back({"link", mean(c[1]) + mean(c[0], -1), {}, {}, rest, {k1}, k1, {}});
  size_t n, links = springs.size();
  for (auto in = open(at + "cells.csv"); in >> kind >> c[0] >> c[1] >> c[2] >> c[3] >> rest;) {
    Spring s{kind, mean(c[2]) + mean(c[0], -1), mean(c[3]) + mean(c[1], -1), {}, rest, {}, 0, {}};  // area: diagonals
    if (kind != "area") s.a = mean(c[1] + "+" + c[2]) + mean(c[0] + "+" + c[3], -1);  // others: mean sides
    if (kind != "area") s.b = mean(c[2] + "+" + c[3]) + mean(c[0] + "+" + c[1], -1);
    if (kind == "rubber") s.q = mean(c[0]) + mean(c[1], -1) + mean(c[2]) + mean(c[3], -1);
    std::getline(in, kind);
    std::stringstream row(kind);
    for (double& k : s.k) row >> k;
    for (double k : {s.k[0], s.k[1], s.k[2]}) s.largest = std::max(s.largest, fabs(k));
    if (s.kind == "rubber") s.largest = 16 * (s.k[0] + s.k[1]) + s.k[6] + s.k[7];
    V a = of(start, s.a), b = of(start, s.b);
    s.free = {dot(a, a), dot(b, b), 0};
    if (s.kind == "face") s.largest *= rest * std::max(1 / dot(a, a), 1 / dot(b, b));
    springs.push_back(s);
  }
  for (auto in = open(at + "natural.csv"); in >> n >> x >> y >> z;) springs[links + n].free = {x, y, z};
  for (auto& s : springs)  // masses with which steps of 1 are stable: what is at rest does not know them
    for (auto [n, w] : s.a + s.b + s.q) add(std::abs(w) * s.largest * V{1, 1, 1}, n, mass);
  for (auto in = open(at + "supports.csv"); in >> kind >> c[0] >> c[1] >> x;) holds.push_back({mean(c[0]), c[1][0] - 'x', x});
  for (auto in = open(at + "loads.csv"); in >> rest >> x >> y >> z;) add({x, y, z}, rest, load);
  for (auto in = open(at + "check.csv"); in >> kind >> rest >> x >> y >> z >> k1 >> k2 >> k3;)
    if (kind == "equilibrium") add({x, y, z}, rest, truth);
  for (int step = 0; step < 500000 && moved > 1e-11; step++) {
    Field g = gradient(springs, start, u);
    double drag = std::sqrt(std::max(0.0, (v * (g - before)).sum() / ((mass * v * v).sum() + 1e-300)));
    v = ((1 - std::min(drag, 1.0)) * v + (load - g) / mass) / (1 + drag);  // critical for the motion left
    for (auto [parts, axis, miss] : holds) {
      for (auto [n, w] : parts) miss -= w * (u[3 * n + axis] + v[3 * n + axis]);
      for (auto [n, w] : parts) v[3 * n + axis] += miss;
    }
    u += v, before = g, moved = std::abs(v).max() / std::abs(u).max();
  }
  double off = std::abs(u - truth).max() / std::abs(truth).max();
  if (!(moved <= 1e-11)) std::cerr << "not at rest after 500000 steps: the file needs more\n";
  return std::cout << "displacements at rest off by " << off << std::endl, !(off < 1e-6);
}
