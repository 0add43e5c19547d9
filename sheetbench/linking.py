"""What numba's compiled functions are made of: linked, optimised, translated and kept otherwise than it does.

To be imported by `sheetbench.kernels` alone, which makes numba's settings before.
"""

from __future__ import annotations

import os
from itertools import count
from typing import Any

from llvmlite.binding import Linkage, ObjectFileRef, create_new_function_pass_manager, ffi, parse_bitcode
from numba.core import bytecode, codegen

SHORT = 200  # instructions: LLVM inlines functions of at most 50, of more where arguments are constants


class Library(codegen.JITCodeLibrary):  # type: ignore[misc]
    """A compiled function: numba's library, which optimises it, and makes machine code of it, once at most.

    numba links what a function calls into it, and what that calls, and translates it all again. Here it links
    only what is short, which LLVM may inline, and which has machine code only where Python calls it; the rest
    is called by its name, and the cache keeps its machine code beside that of the kernel. What may be linked
    is kept as LLVM code too, which is read only where a kernel is compiled that calls it.
    """

    def __init__(self, codegen: Any, name: str) -> None:
        super().__init__(codegen, name)
        self.enable_object_caching()
        self.code, self.linkable, self.short = b"", b"", False
        self.called: dict[bytes, None] = {}  # machine code of what it calls by name, and that

    def _optimize_functions(self, module: Any) -> None:
        """Have values in registers: all of LLVM's passes, which numba has here too, follow after linking."""
        module.data_layout = self._codegen._data_layout
        passes = create_new_function_pass_manager()
        passes.add_sroa_pass()
        passes.add_simplify_cfg_pass()
        passes.add_refprune_pass()
        for function in module.functions:
            passes.run(function, self._codegen._pass_builder())

    def finalize(self) -> None:
        """Link what is short, have what is not translated."""
        libraries, self._linking_libraries = dict.fromkeys(self._linking_libraries), []
        for library in libraries:
            self.called |= library.called
            if library.short:
                self._linking_libraries.append(library)
            else:
                self.called[library.translated()] = None
        super().finalize()

    def _optimize_final_module(self) -> None:
        super()._optimize_final_module()
        self.short = _is_short(self._final_module)

    def _finalize_final_module(self) -> None:
        self._finalized = True

    def _verify_declare_only_symbols(self) -> None:
        """Allow functions of numba's that are called by name, as others are."""

    def translated(self) -> bytes:
        """Return the machine code, made where it is not there yet."""
        if not self.code:
            super()._finalize_final_module()
            self.code = self._get_compiled_object()
            _loaded.add(self.code)
        return self.code

    def get_pointer_to_function(self, name: str) -> int:
        """Return the address of a function's machine code, 0 where it has none."""
        self._ensure_finalized()
        if any(function.name == name for function in self._final_module.functions):
            self.translated()
        address: int = self._codegen._engine.get_function_address(name)
        return address

    def _get_module_for_linking(self) -> Any:
        if self.linkable and self._shared_module is None:
            self._shared_module = parse_bitcode(self.linkable)
            self._codegen._engine._load_defined_symbols(self._shared_module)
        return super()._get_module_for_linking()

    def serialize_using_object_code(self) -> tuple[str, str, tuple[bytes, bytes, tuple[bytes, ...]]]:
        """Return what the cache keeps."""
        code = self.code if self.short else self.translated()
        linkable = self._get_module_for_linking().as_bitcode() if self.short else b""
        return self.name, "object", (code, linkable, tuple(self.called))

    @classmethod
    def _unserialize(cls, codegen: Any, state: Any) -> Library:
        library: Library = codegen.create_library(state[0])
        library.code, library.linkable, called = state[2]
        library.called, library.short = dict.fromkeys(called), library.linkable != b""
        library._finalized = True
        for code in (*called, library.code):
            if code and code not in _loaded:
                codegen._engine._ee.add_object_file(ObjectFileRef.from_data(code))
                _loaded.add(code)
        codegen._engine.finalize_object()
        return library


_loaded: set[bytes] = set()  # machine code that LLVM has


def _is_short(module: Any) -> bool:
    """Return whether LLVM may inline what a library has for others into those that call it."""
    for each in module.functions:
        own = each.linkage is Linkage.external and not each.is_declaration
        if own and not each.name.startswith("_ZN7cpython"):
            asked = any(b"alwaysinline" in attributes for attributes in each.attributes)
            if asked or sum(1 for block in each.blocks for _ in block.instructions) < SHORT:
                return True
    return False


def _set_environment(self: codegen.JITCPUCodegen, name: str, environment: object) -> None:
    """Tell a function where its Python objects are: what numba does, where the function has machine code."""
    if self._engine.get_global_value_address(name):
        _set_environment_as_numba(self, name, environment)


def _magic(self: codegen.JITCPUCodegen) -> tuple[str, ...]:
    """What a kept function is found by beside its arguments: `Library` keeps it otherwise than numba does."""
    return *_magic_of_numba(self), Library.__module__


codegen.JITCPUCodegen._library_class = Library
_magic_of_numba, _set_environment_as_numba = codegen.JITCPUCodegen.magic_tuple, codegen.JITCPUCodegen.set_env
setattr(codegen.JITCPUCodegen, "set_env", _set_environment)  # noqa: B010  # methods of numba's
setattr(codegen.JITCPUCodegen, "magic_tuple", _magic)  # noqa: B010
# names of functions, which the cache keeps, differ from those that other processes give
bytecode.FunctionIdentity._unique_ids = count(int.from_bytes(os.urandom(5)))
ffi.lib._lock._cblist.clear()  # numba's clock of LLVM's lock, at every call of LLVM: a twentieth of compiling
