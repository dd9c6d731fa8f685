"""A libLLVM is used only after it has worked in a child process."""

import pytest

from reference_tracer import llvm


@pytest.fixture(autouse=True)
def own_cache(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))


def test_a_file_that_is_no_library_does_not_work(tmp_path):
    fake = tmp_path / "libLLVM-19.so"
    fake.write_bytes(b"not a library")
    assert not llvm.works(str(fake))


def test_a_missing_file_does_not_work(tmp_path):
    assert not llvm.works(str(tmp_path / "libLLVM-19.so"))


def test_the_answer_is_remembered_by_file(tmp_path, monkeypatch):
    fake = tmp_path / "libLLVM-19.so"
    fake.write_bytes(b"not a library")
    asked = []
    monkeypatch.setattr(llvm, "_probe", lambda path: asked.append(path) or True)
    assert llvm.works(str(fake))
    assert llvm.works(str(fake))
    assert asked == [str(fake)]


def test_a_changed_file_is_asked_again(tmp_path, monkeypatch):
    fake = tmp_path / "libLLVM-19.so"
    fake.write_bytes(b"one")
    monkeypatch.setattr(llvm, "_probe", lambda path: path == str(fake) and fake.read_bytes() == b"three")
    assert not llvm.works(str(fake))
    fake.write_bytes(b"three")
    assert llvm.works(str(fake))


@pytest.mark.parametrize("content", ["", "[]", "{", '{"a": 3}'])
def test_a_damaged_memory_is_forgotten(tmp_path, content):
    folder = tmp_path / "raycheck"
    folder.mkdir()
    (folder / "llvm.json").write_text(content)
    fake = tmp_path / "libLLVM-19.so"
    fake.write_bytes(b"x")
    assert not llvm.works(str(fake))


def test_the_callers_choice_comes_first_and_newer_before_older(monkeypatch):
    monkeypatch.setenv("DRJIT_LIBLLVM_PATH", "/chosen/libLLVM.so")
    found = llvm.candidates()
    assert found[0] == "/chosen/libLLVM.so"
    versions = [llvm._version(path.rsplit("/", 1)[-1]) for path in found[1:]]
    assert versions == sorted(versions, reverse=True)


@pytest.mark.parametrize(("name", "version"), [("libLLVM-19.so.1", 19), ("libLLVM.so.22.0", 22), ("libLLVM.so", 0)])
def test_versions_are_read_from_file_names(name, version):
    assert llvm._version(name) == version


def test_without_any_the_error_names_what_was_tried_and_the_remedy(monkeypatch):
    monkeypatch.setattr(llvm, "find", lambda: None)
    with pytest.raises(llvm.NoLLVMError, match="apt-get install libllvm19"):
        llvm.use()
