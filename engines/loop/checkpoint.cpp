/// Writes and reads checkpoint files, which appear under their name only when complete, and carry a checksum and a version.
#include "engines/loop/checkpoint.hpp"

#include "engines/geometry/section.hpp"
#include "engines/solids/recipe.hpp"

#include <cerrno>
#include <cstdio>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <sstream>
#include <unistd.h>

namespace graindrive::loop {

namespace {

constexpr std::size_t magic_length = 16, header_length = magic_length + 3 * sizeof(std::uint64_t);

std::string magic(Contents contents) { return contents == Contents::loop ? "GRAINDRIVE-LOOP\n" : "GRAINDRIVE-YADE\n"; }
const char* words(Contents contents) { return contents == Contents::loop ? "GrainLoop" : "a scene on YADE's loop"; }

[[noreturn]] void refuse(const std::string& path, const std::string& why)
{
	throw std::runtime_error("checkpoint " + path + ": " + why);
}

void write_all(int file, const std::string& bytes, const std::string& path)
{
	for (std::size_t done = 0; done < bytes.size();) {
		const ssize_t written = ::write(file, bytes.data() + done, bytes.size() - done);
		if (written < 0 && errno != EINTR) refuse(path, std::string("cannot be written: ") + std::strerror(errno));
		if (written > 0) done += written;
	}
}

/// Closes the file, and removes it unless it was kept.
struct Temporary {
	std::string path;
	int file;
	bool kept = false;
	~Temporary()
	{
		::close(file);
		if (!kept) ::unlink(path.c_str());
	}
};

}  // namespace

std::uint64_t checksum_of(const std::string& bytes)
{
	std::uint64_t hash = 14695981039346656037ull;
	for (const unsigned char byte : bytes) hash = (hash ^ byte) * 1099511628211ull;
	return hash;
}

void write_checkpoint(const std::string& path, const std::string& body, Contents contents)
{
	const std::uint64_t numbers[3] = { checkpoint_version, body.size(), checksum_of(body) };
	Temporary beside{ path + ".part", ::open((path + ".part").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666) };
	if (beside.file < 0) refuse(path, std::string("cannot be written: ") + std::strerror(errno));
	write_all(beside.file, magic(contents) + std::string(reinterpret_cast<const char*>(numbers), sizeof numbers) + body, path);
	if (::fsync(beside.file) != 0) refuse(path, std::string("cannot be flushed to the disk: ") + std::strerror(errno));
	if (std::rename(beside.path.c_str(), path.c_str()) != 0)
		refuse(path, std::string("cannot be renamed into place: ") + std::strerror(errno));
	beside.kept = true;
}

Contents contents_of(const std::string& path)
{
	std::string start(magic_length, 0);
	std::ifstream(path, std::ios::binary).read(start.data(), magic_length);
	return start == magic(Contents::yade_scene) ? Contents::yade_scene : Contents::loop;
}

std::string read_companion(const std::string& path)
{
	const std::string body = read_checkpoint(path);
	std::string companion;
	Unpacker{ body }(companion);
	return companion;
}

std::string read_checkpoint(const std::string& path, Contents expected)
{
	std::ifstream in(path, std::ios::binary);
	if (!in) refuse(path, std::string("cannot be opened: ") + std::strerror(errno));
	std::string all;
	try {
		all.assign(std::istreambuf_iterator<char>(in), {});
	} catch (const std::ios_base::failure&) {
		refuse(path, "cannot be read; is it a folder?");
	}
	if (all.size() < header_length || all.compare(0, magic_length, magic(expected)) != 0)
		refuse(path, std::string("is not a checkpoint of ") + words(expected));
	std::uint64_t numbers[3];
	std::memcpy(numbers, all.data() + magic_length, sizeof numbers);
	if (numbers[0] != checkpoint_version)
		refuse(path, "has version " + std::to_string(numbers[0]) + ", this build reads " + std::to_string(checkpoint_version) +
						 "; continue with the version that wrote it");
	if (all.size() - header_length != numbers[1])
		refuse(path,
			"is truncated: " + std::to_string(all.size() - header_length) + " bytes instead of " + std::to_string(numbers[1]));
	std::string body = all.substr(header_length);
	if (checksum_of(body) != numbers[2]) refuse(path, "is damaged: its checksum does not match its contents");
	return body;
}

void visit_law(Packer& pack, const laws::ContactLaw& law)
{
	pack(std::string(laws::name_of(law)));
	pack(laws::constants_of(law));
}

void visit_law(Unpacker& unpack, laws::ContactLaw& law)
{
	std::string name;
	std::vector<Real> constants;
	unpack(name), unpack(constants);
	try {
		law = laws::law_with(name, constants);
	} catch (const std::invalid_argument& refusal) {
		throw std::runtime_error(std::string("checkpoint: ") + refusal.what());
	}
}

template <int D>
geometry::SharedSurface<D> surface_of(const std::string& recipe)
{
	try {
		const geometry::SharedSurface<3> whole = solids::surface_of(recipe);
		if constexpr (D == 2)
			return std::make_shared<geometry::Section>(whole);
		else
			return whole;
	} catch (const std::invalid_argument& refusal) {
		throw std::runtime_error(std::string("checkpoint: ") + refusal.what());
	}
}

template geometry::SharedSurface<2> surface_of<2>(const std::string&);
template geometry::SharedSurface<3> surface_of<3>(const std::string&);

}  // namespace graindrive::loop
