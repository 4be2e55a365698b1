/// A file of a test that no other test and no other run of the same test shares.
#pragma once
#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <unistd.h>

namespace graindrive::test {

/// A path below the folder for temporary files, named after the running test and this process; what lies there at the end is removed.
/// Tests run side by side, and two of them must not write into one file.
class TemporaryFile {
public:
	TemporaryFile()
	{
		const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
		path_ =
			testing::TempDir() + "graindrive-" + test.test_suite_name() + "-" + test.name() + "-" + std::to_string(::getpid());
	}
	TemporaryFile(const TemporaryFile&) = delete;
	~TemporaryFile() { std::remove(path_.c_str()); }

	const std::string& path() const { return path_; }

private:
	std::string path_;
};

}  // namespace graindrive::test
