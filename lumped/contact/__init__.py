"""Contact of the sheet with rigid obstacles, an item of the lattice each."""

from lumped.contact.contact import Contact, contact_pressure, contacts

__all__ = ["Contact", "contact_pressure", "contacts"]
