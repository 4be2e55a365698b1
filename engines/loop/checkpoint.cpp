/// Checkpoint files: atomic, checksummed, versioned; and what of a Stepper goes into one.
#include "engines/loop/checkpoint.hpp"

#include <cerrno>
#include <cstdio>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <sstream>
#include <unistd.h>

#include "engines/loop/stepper.hpp"

namespace graindrive::loop {

namespace {

constexpr std::size_t magic_length = 16, header_length = magic_length + 3 * sizeof(std::uint64_t);

std::string magic(Contents contents) { return contents == Contents::loop ? "GRAINDRIVE-LOOP\n" : "GRAINDRIVE-YADE\n"; }
const char* words(Contents contents) { return contents == Contents::loop ? "GrainLoop" : "a scene on YADE's loop"; }

std::uint64_t fnv1a(const std::string& bytes)
{
	std::uint64_t hash = 14695981039346656037ull;
	for (const unsigned char byte : bytes) hash = (hash ^ byte) * 1099511628211ull;
	return hash;
}

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

void write_checkpoint(const std::string& path, const std::string& body, Contents contents)
{
	const std::uint64_t numbers[3] = { checkpoint_version, body.size(), fnv1a(body) };
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
	const std::string all((std::istreambuf_iterator<char>(in)), {});
	if (all.size() < header_length || all.compare(0, magic_length, magic(expected)) != 0)
		refuse(path, std::string("is not a checkpoint of ") + words(expected));
	std::uint64_t numbers[3];
	std::memcpy(numbers, all.data() + magic_length, sizeof numbers);
	if (numbers[0] != checkpoint_version)
		refuse(path, "has version " + std::to_string(numbers[0]) + ", this build reads " + std::to_string(checkpoint_version) +
						 "; continue with the version that wrote it");
	if (all.size() - header_length != numbers[1])
		refuse(path,
			"was cut short: " + std::to_string(all.size() - header_length) + " bytes instead of " + std::to_string(numbers[1]));
	std::string body = all.substr(header_length);
	if (fnv1a(body) != numbers[2]) refuse(path, "is damaged: its checksum does not fit its contents");
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

void Stepper::save(const std::string& path, const std::string& companion)
{
	if (body_forces_known) throw std::runtime_error("checkpoint " + path + ": a step is under way; save between steps");
	Packer pack;
	pack(companion);
	const State now = snapshot();
	visit_state(pack, now);
	pack(bool(energy_ledger()));
	if (energy_ledger()) energy_ledger()->visit(pack);
	write_checkpoint(path, pack.bytes);
}

std::unique_ptr<Stepper> Stepper::restore(const std::string& path, int threads, std::string* companion)
{
	const std::string body = read_checkpoint(path);
	Unpacker unpack(body);
	std::string words;
	unpack(words);
	if (companion) *companion = words;
	State saved;
	visit_state(unpack, saved);
	saved.scene.threads = threads;
	auto stepper = std::make_unique<Stepper>(saved.scene);
	stepper->state = std::move(saved);
	stepper->resume();
	bool tracked = false;
	unpack(tracked);
	stepper->track_energy(tracked);
	if (tracked) stepper->energy_ledger()->visit(unpack);
	return stepper;
}

/// The state as it is between steps, springs among it.
State Stepper::snapshot()
{
	if (state.selections > 0) pairs.keep_slips();
	return state;
}

/// What follows from a state that was put in the place of another.
void Stepper::resume()
{
	for (std::uint32_t at = 0; at < n_grains; ++at) row_of[state.index_of[at]] = at;
	measure_reach();
	if (state.selections == 0) return;
	lay_out_pairs();
	find_neighbours();
}

}  // namespace graindrive::loop
