// A lattice that `sheetbench ... --export DIR` wrote, in C++17: explicit steps until it is at rest.
#include <algorithm>
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
struct Spring { std::string kind; Sum a, b; double rest, k1, k2, k3, largest; };
Sum operator+(Sum a, Sum b) { a.insert(a.end(), b.begin(), b.end()); return a; }
V operator+(V a, V b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
V operator*(double s, V a) { return {s * a.x, s * a.y, s * a.z}; }
double dot(V a, V b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
V cross(V a, V b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
V take(const Field& x, int m) { return {x[3 * m], x[3 * m + 1], x[3 * m + 2]}; }
V of(const Field& x, const Sum& s) { V v; for (auto [m, w] : s) v = v + w * take(x, m); return v; }
void add(V f, int m, Field& g) { g[3 * m] += f.x, g[3 * m + 1] += f.y, g[3 * m + 2] += f.z; }
Field gradient(const std::vector<Spring>& springs, const Field& start, const Field& u) {  // see README.md
  Field g(u.size()), now = start + u;
  for (auto& s : springs) {
    V a = of(now, s.a), b = of(now, s.b), a0 = of(start, s.a), b0 = of(start, s.b), c = cross(a, b), by_a, by_b;
    double aa = dot(a0, a0), bb = dot(b0, b0), t3 = s.k3 * dot(a, b) / s.rest, cc = dot(c, c);
    if (s.kind == "link") by_a = s.k1 * (1 - s.rest / sqrt(dot(a, a))) * a;
    if (s.kind == "area") c = s.k1 / 2 * (0.5 / s.rest - 1 / sqrt(cc)) * c, by_a = cross(b, c), by_b = cross(c, a);
    if (s.kind == "strain") by_a = s.k1 / 2 * (dot(a, a) / aa - 1) * s.rest / aa * a + t3 * b;
    if (s.kind == "strain") by_b = s.k2 / 2 * (dot(b, b) / bb - 1) * s.rest / bb * b + t3 * a;
    for (auto [m, w] : s.a) add(w * by_a, m, g);
    for (auto [m, w] : s.b) add(w * by_b, m, g);
  }
  return g;
}
std::stringstream open(std::string path, std::string all = "", std::string part = "") {
  for (std::ifstream file(path); std::getline(file, part, ',');) all += part + " ";
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
  for (auto in = open(at + "nodes.csv"); in >> kind >> c[0] >> c[1] >> c[2] >> x >> y >> z >> kind;)
    places.insert(places.end(), {x, y, z});
  Field start(places.data(), places.size()), u(start.size()), v = u, load = u, truth = u, before = u, mass = u;
  for (auto in = open(at + "links.csv"); in >> c[0] >> c[1] >> kind >> rest >> k1 >> x;)
    springs.push_back({"link", mean(c[1]) + mean(c[0], -1), {}, rest, k1, 0, 0, k1});
  for (auto in = open(at + "cells.csv"); in >> kind >> c[0] >> c[1] >> c[2] >> c[3] >> rest >> k1 >> k2 >> k3;) {
    Sum a = mean(c[2]) + mean(c[0], -1), b = mean(c[3]) + mean(c[1], -1);  // diagonals, for strains mean sides
    if (kind != "area" && kind != "strain") return std::cerr << "knows no rubber; read_lattice.py does\n", 2;
    if (kind == "strain") a = mean(c[1] + "+" + c[2]) + mean(c[0] + "+" + c[3], -1);
    if (kind == "strain") b = mean(c[2] + "+" + c[3]) + mean(c[0] + "+" + c[1], -1);
    springs.push_back({kind, a, b, rest, k1, k2, k3, std::max({fabs(k1), fabs(k2), fabs(k3)})});
    std::getline(in, kind);
  }
  for (auto& s : springs)  // masses with which steps of 1 are stable: what is at rest does not know them
    for (auto [n, w] : s.a + s.b) add(std::abs(w) * s.largest * V{1, 1, 1}, n, mass);
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
