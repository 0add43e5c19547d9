"""Setting of glibc's malloc: keep the memory that arrays free, for a whole process."""


def keep_freed_memory() -> None:
    """Let the process reuse the memory that arrays of up to 31 MB free.

    Otherwise the system takes the memory back after every factorisation and clears it: a shell takes 1.08
    times as long on 8 × 8 elements and 1.05 times on 16 × 16. Allocating factors and their workspace once for
    a pattern would save only the first of the two: on larger meshes the elements' matrices cost as much. An
    array that is allocated, never touched and freed raises glibc's threshold for returning memory; on other
    systems nothing changes.
    """
    bytes(31 << 20)
