// The waves of a package as the kernels take them: fftocean's docs/kernels.md has the bytes.
// No Unreal in here: this header is compiled, run and compared with fftocean's own arrays.
#pragma once
#include "sea_waves.hpp"

struct FSeaTile // 64 bytes: a structured buffer's element
{
	std::uint32_t Nx, Ny, First, FirstMap;
	float Lx, Ly, Dkx, Dky;
	float Lifts[4];
	float OriginX, OriginY, Unused[2];
};
static_assert(sizeof(FSeaTile) == 64, "the layout of SeaTile in Sea.usf");

struct FSeaLayout
{
	static constexpr std::uint32_t MostSide = 512; // of the kernels: a line takes 16 KiB

	std::vector<FSeaTile> Tiles;
	std::vector<float> H0, Wave, Twiddle; // four, two and two numbers an entry
	std::uint32_t Ticks = 0, Texels = 0, MapTexels = 0; // MapTexels: without foam
	std::uint32_t Groups = 1; // of the kernels Rows and Columns, for each tile
	float Decay = 0.f, Threshold = 0.f, Strength = 0.f; // of foam [s], [-], [1/s]

	FSeaLayout() = default;

	explicit FSeaLayout(const fftocean::SeaWaves& Sea)
	{
		using fftocean::must;
		const fftocean::Json& Document = Sea.document;
		Ticks = std::uint32_t(Document["ticks"].number);
		const fftocean::Json& Foam = Document["foam"];
		Decay = float(Foam["decay"].number);
		Threshold = float(Foam["threshold"].number);
		Strength = float(Foam["strength"].number);
		must(Decay > 0.f, "foam of sea.json must have a decay");
		std::uint32_t Longest = 2;
		for (std::size_t i = 0; i < Sea.sizes.size(); i++)
		{
			const fftocean::Json& One = Document["tiles"].items[i];
			FSeaTile Tile{};
			Tile.Nx = std::uint32_t(One["n"].items[0].number);
			Tile.Ny = std::uint32_t(One["n"].items[1].number);
			must(std::max(Tile.Nx, Tile.Ny) <= MostSide, "n of tile " + std::to_string(i)
				+ " must be at most " + std::to_string(MostSide) + " for the kernels");
			Tile.First = Texels;
			Tile.FirstMap = MapTexels;
			Tile.Lx = float(Sea.sizes[i][0]);
			Tile.Ly = float(Sea.sizes[i][1]);
			Tile.Dkx = float(TwoPi / Sea.sizes[i][0]);
			Tile.Dky = float(TwoPi / Sea.sizes[i][1]);
			Tile.Lifts[0] = Tile.Lifts[2] = Tile.Lifts[3] = 1.f;
			Tile.Lifts[1] = float(One["mixed"].number);
			Texels += Tile.Nx * Tile.Ny;
			MapTexels += 3 * TexelsOfLevels(Tile.Nx, Tile.Ny);
			Longest = std::max({Longest, Tile.Nx, Tile.Ny});
			Groups = std::max(Groups, Tile.Nx * Tile.Ny / MostSide);
			Tiles.push_back(Tile);
		}
		H0.resize(4 * std::size_t(Texels));
		Wave.resize(2 * std::size_t(Texels));
		const fftocean::Json& Depth = Document["depth"];
		for (std::size_t i = 0; i < Tiles.size(); i++)
			FillFactors(Tiles[i], Sea.sizes[i],
				Depth.kind == fftocean::Json::Number ? Depth.number : HUGE_VAL);
		for (const fftocean::Wave& One : Sea.waves) Put(Tiles[std::size_t(One.tile)], One);
		for (std::uint32_t i = 0; i < Longest; i++)
		{
			Twiddle.push_back(float(std::cos(TwoPi * i / Longest)));
			Twiddle.push_back(float(std::sin(TwoPi * i / Longest)));
		}
	}

	// Texels of all levels of a plane.
	static std::uint32_t TexelsOfLevels(std::uint32_t Nx, std::uint32_t Ny)
	{
		const std::uint32_t Next = Nx * Ny > 1
			? TexelsOfLevels(std::max(Nx / 2, 1u), std::max(Ny / 2, 1u)) : 0;
		return Nx * Ny + Next;
	}

private:
	static constexpr double TwoPi = 6.283185307179586;

	static double Whole(std::uint32_t i, std::uint32_t n) { return 2 * i < n ? double(i) : double(i) - n; }

	// 1 / (k tanh(k depth)) of every wavenumber.
	void FillFactors(const FSeaTile& Tile, const std::array<double, 2>& Size, double Depth)
	{
		for (std::uint32_t y = 0; y < Tile.Ny; y++)
			for (std::uint32_t x = 0; x < Tile.Nx; x++)
			{
				const double k = std::hypot(TwoPi * Whole(x, Tile.Nx) / Size[0],
					TwoPi * Whole(y, Tile.Ny) / Size[1]);
				const std::size_t At = Tile.First + y * Tile.Nx + x;
				Wave[2 * At + 1] = k > 0.0 ? float(1.0 / (k * std::tanh(k * Depth))) : 0.f;
			}
	}

	// A wave's h0 at k, and its complex conjugate at -k. SeaWaves has them doubled.
	void Put(const FSeaTile& Tile, const fftocean::Wave& One)
	{
		const int Nx = int(Tile.Nx), Ny = int(Tile.Ny), Mx = int(One.mx), My = int(One.my);
		const std::size_t At = Tile.First + std::size_t((My + Ny) % Ny * Nx + (Mx + Nx) % Nx);
		const std::size_t Opposite = Tile.First + std::size_t((Ny - My) % Ny * Nx + (Nx - Mx) % Nx);
		H0[4 * At] = float(One.re / 2.0);
		H0[4 * At + 1] = float(One.im / 2.0);
		H0[4 * Opposite + 2] = float(One.re / 2.0);
		H0[4 * Opposite + 3] = float(-One.im / 2.0);
		Wave[2 * At] = Wave[2 * Opposite] = float(One.cycles);
	}
};
