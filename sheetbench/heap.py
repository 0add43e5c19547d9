"""What glibc's malloc does with memory that arrays free: a setting of the process, not of a library's."""


def keep_freed_memory() -> None:
    """Have this process keep the memory that arrays of up to 31 MB free, and use it again.

    Without it the system takes that back after every factorisation and clears it again: a shell takes 1.08
    times as long on 8 × 8 elements and 1.05 times on 16 × 16. Factors and their workspace allocated once for
    a pattern have the first back and not the second: on larger meshes it is the elements' matrices as much as
    the factors. Allocated, never touched and freed, an array raises the threshold that glibc gives memory
    back from; under other systems nothing changes.
    """
    bytes(31 << 20)
