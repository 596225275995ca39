"""Random models of everything that is declared, strict checks of their rows, and twins that must agree with them."""
