"""Contact of the sheet with rigid obstacles, an item of the lattice each."""

from lumped.contact.contact import Contact, contacts

__all__ = ["Contact", "contacts"]
