// The sea of a run-time package in C++17, one header, without a GPU and without other libraries:
//     fftocean export-sea -o sea
//     const fftocean::SeaWaves sea("sea");        // every wave
//     const fftocean::SeaWaves fast("sea", 500);  // the strongest, without fast.neglected_rms [m]
//     fftocean::Water water = sea.at(x, y, t);    // the water above a place: water.height, .normal
//     fftocean::Water buoy = sea.rest(x0, y0, t); // the water that rests at a place: buoy.x, .y
// x east, y north, z up, metres, seconds. Unreal: at(X / 100, -Y / 100, t), height * 100,
// normal (n[0], -n[1], n[2]). Threads can share a sea: its methods are const.
// A damaged package is refused by fftocean::SeaError, which names the file and the rule.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <locale>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace fftocean {

using Bytes = std::vector<std::uint8_t>;

struct SeaError : std::runtime_error { using std::runtime_error::runtime_error; };

inline void must(bool right, const std::string& rule) { if (!right) throw SeaError(rule); }

// A value of JSON; numbers are finite.
struct Json {
    enum Kind { Null, Bool, Number, Text, List, Object } kind = Null;
    double number = 0.0;
    std::string text;
    std::vector<Json> items;
    std::vector<std::string> keys; // of an object, beside its items
    const Json& operator[](const std::string& key) const {
        static const Json none;
        for (std::size_t i = keys.size(); i-- > 0;) if (keys[i] == key) return items[i];
        return none;
    }
    bool is_positive() const { return kind == Number && number > 0.0; }
    bool is_whole(double low, double high) const {
        return kind == Number && number >= low && number <= high && number == std::floor(number);
    }
    bool is_power(double most) const {
        return is_whole(2.0, most) && std::log2(number) == std::floor(std::log2(number));
    }
};

class JsonReader {
public:
    static constexpr int deepest = 32;
    static Json read(const std::string& text) {
        JsonReader reader(text);
        Json value = reader.value(0);
        reader.space();
        reader.need(reader.at == text.size());
        return value;
    }

private:
    explicit JsonReader(const std::string& text) : s(text) {}
    const std::string& s;
    std::size_t at = 0;
    void need(bool right) const { must(right, "sea.json must be JSON"); }
    char here() const { return at < s.size() ? s[at] : '\0'; }
    void space() { while (at < s.size() && std::strchr(" \n\r\t", s[at])) at++; }
    bool take(const char* word) {
        const std::size_t length = std::strlen(word);
        const bool same = s.compare(at, length, word) == 0;
        if (same) at += length;
        return same;
    }
    Json value(int depth) {
        must(depth <= deepest, "sea.json must nest at most 32 deep");
        space();
        Json made;
        if (here() == '{' || here() == '[') {
            const char end = here() == '{' ? '}' : ']';
            made.kind = here() == '{' ? Json::Object : Json::List;
            at++;
            for (space(); here() != end; space()) {
                if (!made.items.empty()) need(take(","));
                if (end == '}') {
                    space();
                    need(here() == '"');
                    made.keys.push_back(text());
                    space();
                    need(take(":"));
                }
                made.items.push_back(value(depth + 1));
            }
            at++;
        } else if (here() == '"') {
            made.kind = Json::Text;
            made.text = text();
        } else if (take("true") || take("false")) {
            made.kind = Json::Bool;
        } else if (!take("null")) {
            const std::size_t end = std::min(s.find_first_not_of("+-.0123456789eE", at), s.size());
            std::istringstream number(s.substr(at, end - at));
            number.imbue(std::locale::classic()); // a point, in every country
            made.kind = Json::Number;
            need(end > at && number >> made.number && number.peek() == EOF);
            need(std::isfinite(made.number));
            at = end;
        }
        return made;
    }
    std::string text() { // escapes stay as they are, but for quotes: no key or value here has any
        std::string made;
        for (at++; here() != '"'; at++) {
            need(at < s.size());
            if (here() == '\\') at++;
            made += here();
        }
        at++;
        return made;
    }
};

// FIPS 180-4.
inline std::string sha256(const Bytes& bytes) {
    std::array<std::uint32_t, 64> k{}, w{};
    std::array<std::uint32_t, 8> h{};
    for (int n = 2, count = 0; count < 64; n++) {
        bool prime = true;
        for (int d = 2; d * d <= n; d++) prime = prime && n % d != 0;
        if (!prime) continue;
        const double cube = std::cbrt(double(n)), square = std::sqrt(double(n));
        k[count] = std::uint32_t((cube - std::floor(cube)) * 4294967296.0);
        if (count < 8) h[count] = std::uint32_t((square - std::floor(square)) * 4294967296.0);
        count++;
    }
    Bytes data = bytes;
    data.push_back(128);
    data.resize((data.size() + 8 + 63) / 64 * 64);
    for (int i = 0; i < 8; i++)
        data[data.size() - 1 - i] = std::uint8_t(std::uint64_t(bytes.size()) * 8 >> 8 * i);
    const auto turn = [](std::uint32_t x, int n) { return x >> n | x << (32 - n); };
    for (std::size_t at = 0; at < data.size(); at += 64) {
        auto v = h;
        for (int i = 0; i < 64; i++) {
            if (i < 16) {
                w[i] = 0;
                for (int b = 0; b < 4; b++) w[i] = w[i] << 8 | data[at + 4 * i + b];
            } else {
                const std::uint32_t p = w[i - 15], q = w[i - 2];
                w[i] = w[i - 16] + w[i - 7] + (turn(p, 7) ^ turn(p, 18) ^ p >> 3)
                    + (turn(q, 17) ^ turn(q, 19) ^ q >> 10);
            }
            const std::uint32_t one = v[7] + (turn(v[4], 6) ^ turn(v[4], 11) ^ turn(v[4], 25))
                + ((v[4] & v[5]) ^ (~v[4] & v[6])) + k[i] + w[i];
            const std::uint32_t two = (turn(v[0], 2) ^ turn(v[0], 13) ^ turn(v[0], 22))
                + ((v[0] & v[1]) ^ (v[0] & v[2]) ^ (v[1] & v[2]));
            v = {one + two, v[0], v[1], v[2], v[3] + one, v[4], v[5], v[6]};
        }
        for (int i = 0; i < 8; i++) h[i] += v[i];
    }
    std::string hexadecimal;
    for (std::uint32_t word : h)
        for (int i = 28; i >= 0; i -= 4) hexadecimal += "0123456789abcdef"[word >> i & 15];
    return hexadecimal;
}

struct Water {
    double x0, y0; // place at rest [m]
    double x, y, height; // place now [m]
    std::array<double, 3> normal; // unit, up
    double residual; // distance from the place that was asked for [m]
    double jacobian; // 0 or less: in a fold, one of several
    std::array<double, 3> gradient; // of the place now: dx/dx0, dx/dy0 = dy/dx0, dy/dy0
};

struct Wave {
    int tile;
    double mx, my, cycles, re, im; // height: the real part of (re + i im) e^(i phase)
    double kx, ky, f; // [rad/m], [m]
    double square() const { return re * re + im * im; }
};

class SeaWaves {
public:
    // Give a file's bytes, at most so many and one more; none if it does not exist.
    using Read = std::function<std::pair<bool, Bytes>(const std::string& name, std::size_t limit)>;

    std::vector<Wave> waves;
    std::vector<std::array<double, 2>> sizes; // of the tiles [m]
    double loop = 0.0, choppiness = 0.0, neglected_rms = 0.0; // [s], [-], [m]
    Json document;

    explicit SeaWaves(const std::string& folder, std::size_t strongest = SIZE_MAX)
        : SeaWaves([folder](const std::string& name, std::size_t limit) {
              std::ifstream file(folder + "/" + name, std::ios::binary);
              Bytes bytes;
              for (char c; bytes.size() <= limit && file.get(c);) bytes.push_back(std::uint8_t(c));
              return std::make_pair(file.is_open(), std::move(bytes));
          }, strongest) {}

    explicit SeaWaves(const Read& read, std::size_t strongest = SIZE_MAX) {
        document = parsed(read("sea.json", most));
        must(document["loop"].is_positive(), "loop of sea.json must be a positive number");
        must(document["choppiness"].kind == Json::Number,
            "choppiness of sea.json must be a number");
        const Json& given = document["depth"];
        must(given.kind == Json::Null || given.is_positive(),
            "depth of sea.json must be null or a positive number");
        loop = document["loop"].number;
        choppiness = document["choppiness"].number;
        const double depth = given.kind == Json::Null ? HUGE_VAL : given.number;
        for (std::size_t i = 0; i < document["tiles"].items.size(); i++) add_tile(i, depth, read);
        const auto stronger = [](const Wave& a, const Wave& b) { return a.square() > b.square(); };
        std::stable_sort(waves.begin(), waves.end(), stronger);
        double lost = 0.0;
        for (std::size_t i = strongest; i < waves.size(); i++) lost += waves[i].square() / 2.0;
        neglected_rms = std::sqrt(lost);
        if (strongest < waves.size()) waves.resize(strongest);
    }

    // Water that rests at (x0, y0): it is at (x, y, height) now.
    Water rest(double x0, double y0, double t) const { return water(x0, y0, x0, y0, t); }

    // Water above (x, y), that is x0 + choppiness D(x0) = x, by Newton's method.
    Water at(double x, double y, double t) const {
        Water found = water(x, y, x, y, t);
        double least = found.jacobian;
        for (int i = 0; i < 30 && found.residual > 1e-9; i++) {
            const double dx = found.x - x, dy = found.y - y;
            const double j = std::max(found.jacobian, 0.2); // short steps near a fold
            const auto [xx, xy, yy] = found.gradient;
            found = water(x, y, found.x0 - (yy * dx - xy * dy) / j,
                found.y0 - (xx * dy - xy * dx) / j, t);
            least = std::min(least, found.jacobian);
        }
        found.jacobian = least;
        return found;
    }

private:
    static constexpr std::size_t most = 1048576; // bytes of sea.json
    static constexpr double two_pi = 6.283185307179586;

    Water water(double x, double y, double x0, double y0, double t) const {
        const double now = std::fmod(t, loop) / loop, c = choppiness;
        std::array<std::array<double, 2>, 16> place{}; // in each tile's own period
        for (std::size_t i = 0; i < sizes.size(); i++)
            place[i] = {std::fmod(x0, sizes[i][0]) / sizes[i][0],
                std::fmod(y0, sizes[i][1]) / sizes[i][1]};
        double height = 0, dx = 0, dy = 0, sx = 0, sy = 0, xx = 0, xy = 0, yy = 0;
        for (const Wave& w : waves) {
            double turn = w.mx * place[w.tile][0] + w.my * place[w.tile][1] - w.cycles * now;
            const double angle = two_pi * (turn - std::round(turn));
            const double cosine = std::cos(angle), sine = std::sin(angle);
            const double a = w.re * cosine - w.im * sine, b = w.re * sine + w.im * cosine;
            const double fa = w.f * a, fb = w.f * b;
            height += a;
            sx -= w.kx * b, sy -= w.ky * b, dx -= w.kx * fb, dy -= w.ky * fb;
            xx -= w.kx * w.kx * fa, xy -= w.kx * w.ky * fa, yy -= w.ky * w.ky * fa;
        }
        xx = 1.0 + c * xx, xy = c * xy, yy = 1.0 + c * yy;
        std::array<double, 3> n{xy * sy - yy * sx, xy * sx - xx * sy, xx * yy - xy * xy};
        const double jacobian = n[2], length = std::hypot(n[0], n[1], n[2]);
        for (double& part : n) part /= length;
        const double to_x = x0 + c * dx, to_y = y0 + c * dy;
        return {x0, y0, to_x, to_y, height, n, std::hypot(to_x - x, to_y - y), jacobian,
            {xx, xy, yy}};
    }

    // The document, checked: its checksum is that of all before the last key.
    static Json parsed(const std::pair<bool, Bytes>& file) {
        must(file.first, "sea.json does not exist");
        const std::string text(file.second.begin(), file.second.end());
        must(text.size() <= most, "sea.json must have at most 1048576 bytes, got more");
        const Json tree = JsonReader::read(text);
        must(tree["format"].text == "fftocean-runtime",
            "format of sea.json must be fftocean-runtime, got " + tree["format"].text);
        must(tree["version"].is_whole(1, 1), "version of sea.json must be 1, got "
            + std::to_string(tree["version"].number));
        const std::string end = ",\n  \"check\": \"" + tree["check"].text + "\"\n}\n";
        const std::size_t start = text.size() - std::min(end.size(), text.size());
        const std::string rest = text.substr(0, start) + "\n}\n";
        must(text.compare(start, std::string::npos, end) == 0
            && sha256(Bytes(rest.begin(), rest.end())) == tree["check"].text,
            "sea.json was changed after it was written");
        must(tree["ticks"].is_power(1048576),
            "ticks of sea.json must be a power of two from 2 to 1048576");
        const Json& tiles = tree["tiles"];
        must(tiles.kind == Json::List && !tiles.items.empty() && tiles.items.size() <= 16,
            "tiles of sea.json must be a list of 1 to 16");
        must(tree["files"].kind == Json::List, "files of sea.json must be a list");
        return tree;
    }

    void add_tile(std::size_t index, double depth, const Read& read) {
        const Json& tile = document["tiles"].items[index];
        const std::string number = std::to_string(index), name = "tile" + number + ".waves";
        const std::string of = " of tile " + number + " in sea.json must ";
        const Json &n = tile["n"], &size = tile["size"];
        must(n.items.size() == 2 && n.items[0].is_power(1024) && n.items[1].is_power(1024),
            "n" + of + "be two powers of two from 2 to 1024");
        must(size.items.size() == 2 && size.items[0].is_positive() && size.items[1].is_positive(),
            "size" + of + "be two positive numbers");
        const int nx = int(n.items[0].number), ny = int(n.items[1].number);
        const double lx = size.items[0].number, ly = size.items[1].number;
        const Json &count = tile["waves"], &fastest = tile["most_cycles"];
        must(count.is_whole(0.0, double(nx) * ny) && fastest.is_whole(0.0, 65535.0),
            "waves" + of + "fit its n and most_cycles");
        const double sum = 14.0 * count.number;
        const std::size_t expected = std::size_t(sum);
        std::string digest;
        for (const Json& file : document["files"].items)
            if (file["name"].text == name && file["bytes"].is_whole(sum, sum))
                digest = file["sha256"].text;
        const auto size_text = std::to_string(expected);
        must(digest.size() == 64,
            "sea.json must list " + name + " with " + size_text + " bytes and its SHA-256");
        const auto [exists, bytes] = read(name, expected);
        must(exists, name + " does not exist");
        must(bytes.size() == expected, name + " must have " + size_text + " bytes, got "
            + (bytes.size() > expected ? "more" : std::to_string(bytes.size())));
        must(sha256(bytes) == digest, name + " was changed after it was written");
        sizes.push_back({lx, ly});
        for (std::size_t i = 0, last = 0; i < expected / 14; i++) {
            const auto word = [&bytes = bytes, i](int byte) {
                return std::uint32_t(bytes[14 * i + byte] | bytes[14 * i + byte + 1] << 8);
            };
            const auto real = [&word](int byte) {
                const std::uint32_t bits = word(byte) | word(byte + 2) << 16;
                float value;
                std::memcpy(&value, &bits, 4);
                return 2.0 * double(value);
            };
            const int mx = std::int16_t(word(0)), my = std::int16_t(word(2)), cycles = int(word(4));
            const double kx = two_pi * mx / lx, ky = two_pi * my / ly, k = std::hypot(kx, ky);
            const Wave wave{int(index), double(mx), double(my), double(cycles), real(6), real(10),
                kx, ky, 1.0 / (k * std::tanh(k * depth))};
            const std::size_t place = std::size_t((my + ny) % ny * nx + (mx + nx) % nx) + 1;
            const std::string record = "record " + std::to_string(i) + " of " + name + " must ";
            must(2 * std::abs(mx) < nx && 2 * std::abs(my) < ny && (mx || my),
                record + "have |mx| < " + std::to_string(nx / 2) + " and |my| < "
                + std::to_string(ny / 2) + ", not both 0");
            must(place > last, record + "follow the one before in the plane");
            must(wave.square() > 0.0 && std::isfinite(wave.square()),
                record + "have a finite amplitude, not 0");
            must(cycles >= 1 && cycles <= int(fastest.number),
                record + "have 1 to " + std::to_string(int(fastest.number)) + " cycles");
            last = place;
            waves.push_back(wave);
        }
    }
};

} // namespace fftocean
