/// One file that holds a running loop to the last bit, written whole or not at all.
///
/// Layout: what it holds (16 letters), version, length of the body, FNV-1a checksum of the body (three 64-bit numbers of this machine's byte
/// order), then the body. The body of a loop: the caller's text, then every array of the complete state, in the order in which it
/// lies in memory. The body of a scene on YADE's own loop: the bytes of O.save.
#pragma once
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "engines/laws/registry.hpp"
#include "engines/loop/scene.hpp"

namespace graindrive::loop {

constexpr std::uint64_t checkpoint_version = 10;

/// What a file holds, in the 16 letters that it begins with.
enum class Contents { loop, yade_scene };

/// Writes beside `path`, flushes to the disk, renames. @throws std::runtime_error naming the file and the system's reason
void write_checkpoint(const std::string& path, const std::string& body, Contents contents = Contents::loop);

/// The body of a checkpoint. @throws std::runtime_error saying why a file is refused: missing, foreign, of another version, cut short, damaged
std::string read_checkpoint(const std::string& path, Contents expected = Contents::loop);

/// The caller's text of a loop's checkpoint, without the loop. @throws as read_checkpoint
std::string read_companion(const std::string& path);

/// FNV-1a, the checksum of a file's body and of a scene's solids.
std::uint64_t checksum_of(const std::string& bytes);

/// What a file says that it holds; a loop where it says nothing that is known.
Contents contents_of(const std::string& path);

/// The surface that a recipe makes, in the plane the section of one in space.
template <int D>
geometry::SharedSurface<D> surface_of(const std::string& recipe);

/// Plain numbers and arrays of them, one behind the other.
class Packer {
public:
	std::string bytes;

	template <class T>
	void operator()(const T& number)
	{
		static_assert(std::is_trivially_copyable_v<T>);
		bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
	}
	template <class T, class Allocator>
	void operator()(const std::vector<T, Allocator>& list)
	{
		static_assert(std::is_trivially_copyable_v<T>);
		(*this)(std::uint64_t(list.size()));
		bytes.append(reinterpret_cast<const char*>(list.data()), list.size() * sizeof(T));
	}
	void operator()(const std::string& text)
	{
		(*this)(std::uint64_t(text.size()));
		bytes += text;
	}
};

/// Reads what a Packer wrote, in the same order.
class Unpacker {
public:
	explicit Unpacker(const std::string& from) : bytes(from) {}

	template <class T>
	void operator()(T& number)
	{
		std::memcpy(&number, take(sizeof number), sizeof number);
	}
	template <class T, class Allocator>
	void operator()(std::vector<T, Allocator>& list)
	{
		std::uint64_t size = 0;
		(*this)(size);
		const char* from = take(size * sizeof(T));
		list.resize(size);
		if (size > 0) std::memcpy(static_cast<void*>(list.data()), from, size * sizeof(T));
	}
	void operator()(std::string& text)
	{
		std::uint64_t size = 0;
		(*this)(size);
		text.assign(take(size), size);
	}

private:
	const std::string& bytes;
	std::size_t at = 0;

	const char* take(std::size_t count)
	{
		if (count > bytes.size() - at) throw std::runtime_error("checkpoint ends too early; it was written by another build");
		at += count;
		return bytes.data() + at - count;
	}
};

/// A law as its name and constants, so that a file does not depend on the order of the registry.
void visit_law(Packer& pack, const laws::ContactLaw& law);
/// @throws std::runtime_error naming a law that this build does not have as the file has it
void visit_law(Unpacker& unpack, laws::ContactLaw& law);

/// Solids as the recipes of their surfaces.
template <int D>
void visit_solids(Packer& pack, const std::vector<Solid<D>>& solids)
{
	pack(std::uint64_t(solids.size()));
	for (const Solid<D>& solid : solids) pack(solid.body), pack(solid.recipe);
}
/// @throws std::runtime_error for a recipe that this build cannot make a surface of
template <int D>
void visit_solids(Unpacker& unpack, std::vector<Solid<D>>& solids)
{
	std::uint64_t count = 0;
	unpack(count);
	solids.resize(count);
	for (Solid<D>& solid : solids) unpack(solid.body), unpack(solid.recipe), solid.shape = surface_of<D>(solid.recipe);
}

}  // namespace graindrive::loop
